//! The works cited in this crate, each under an anchor.
//!
//! <a id="rubio-2006"></a>
//! - **rubio-2006** — M. A. Rubio, A. Urquia, L. González, D. Guinea, S. Dormido: GAPILib, a
//!   Modelica library for model parameter identification using genetic algorithms. 5th
//!   International Modelica Conference, 2006.
//!
//! <a id="mls-3.6"></a>
//! - **mls-3.6** — Modelica Association: Modelica, a unified object-oriented language for systems
//!   modeling. Language specification, version 3.6, 2023.
//!
//! <a id="lecuyer-1999"></a>
//! - **lecuyer-1999** — P. L'Ecuyer: Good parameters and implementations for combined multiple
//!   recursive random number generators. Operations Research 47(1), 1999, 159–164.
//!
//! <a id="lecuyer-2002"></a>
//! - **lecuyer-2002** — P. L'Ecuyer, R. Simard, E. J. Chen, W. D. Kelton: An object-oriented
//!   random-number package with many long streams and substreams. Operations Research 50(6), 2002,
//!   1073–1075.
//!
//! <a id="tanese-1989"></a>
//! - **tanese-1989** — R. Tanese: Distributed genetic algorithms. Proceedings of the Third
//!   International Conference on Genetic Algorithms, 1989, 434–439.
//!
//! <a id="polychronopoulos-kuck-1987"></a>
//! - **polychronopoulos-kuck-1987** — C. D. Polychronopoulos, D. J. Kuck: Guided self-scheduling: a
//!   practical scheduling scheme for parallel supercomputers. IEEE Transactions on Computers C-36(12),
//!   1987, 1425–1439.
//!
//! <a id="akima-1970"></a>
//! - **akima-1970** — H. Akima: A new method of interpolation and smooth curve fitting based on
//!   local procedures. Journal of the ACM 17(4), 1970, 589–602.
//!
//! <a id="akima-1974"></a>
//! - **akima-1974** — H. Akima: A method of bivariate interpolation and smooth surface fitting
//!   based on local procedures. Communications of the ACM 17(1), 1974, 18–20.
//!
//! <a id="anderson-1999"></a>
//! - **anderson-1999** — E. Anderson et al.: LAPACK users' guide. 3rd edition, SIAM, 1999.
//!
//! <a id="james-2014"></a>
//! - **james-2014** — R. James, J. Langou, B. R. Lowery: On matrix balancing and eigenvector
//!   computation. arXiv:1401.5766, 2014.
//!
//! <a id="cooley-tukey-1965"></a>
//! - **cooley-tukey-1965** — J. W. Cooley, J. W. Tukey: An algorithm for the machine calculation of
//!   complex Fourier series. Mathematics of Computation 19(90), 1965, 297–301.
//!
//! <a id="fritsch-butland-1984"></a>
//! - **fritsch-butland-1984** — F. N. Fritsch, J. Butland: A method for constructing local monotone
//!   piecewise cubic interpolants. SIAM Journal on Scientific and Statistical Computing 5(2), 1984,
//!   300–304.
//!
//! <a id="steffen-1990"></a>
//! - **steffen-1990** — M. Steffen: A simple method for monotonic interpolation in one dimension.
//!   Astronomy and Astrophysics 239, 1990, 443–450.
//!
//! <a id="vigna-2016"></a>
//! - **vigna-2016** — S. Vigna: An experimental exploration of Marsaglia's xorshift generators,
//!   scrambled. ACM Transactions on Mathematical Software 42(4), 2016.
//!
//! <a id="vigna-2017"></a>
//! - **vigna-2017** — S. Vigna: Further scramblings of Marsaglia's xorshift generators. Journal of
//!   Computational and Applied Mathematics 315, 2017, 175–181.
//!
//! <a id="griewank-2008"></a>
//! - **griewank-2008** — A. Griewank, A. Walther: Evaluating derivatives: principles and techniques
//!   of algorithmic differentiation. 2nd edition, SIAM, 2008.
//!
//! <a id="larminie-dicks-2000"></a>
//! - **larminie-dicks-2000** — J. Larminie, A. Dicks: Fuel cell systems explained. Wiley, 2000.
//!
//! <a id="brenan-campbell-petzold-1996"></a>
//! - **brenan-campbell-petzold-1996** — K. E. Brenan, S. L. Campbell, L. R. Petzold: Numerical
//!   solution of initial-value problems in differential-algebraic equations. SIAM, 1996 (DASSL).
//!
//! <a id="shampine-reichelt-1997"></a>
//! - **shampine-reichelt-1997** — L. F. Shampine, M. W. Reichelt: The MATLAB ODE suite. SIAM
//!   Journal on Scientific Computing 18(1), 1997, 1–22 (NDF formulas).
//!
//! <a id="feehery-tolsma-barton-1997"></a>
//! - **feehery-tolsma-barton-1997** — W. F. Feehery, J. E. Tolsma, P. I. Barton: Efficient
//!   sensitivity analysis of large-scale differential-algebraic systems. Applied Numerical
//!   Mathematics 25(1), 1997, 41–54.
//!
//! <a id="galan-feehery-barton-1999"></a>
//! - **galan-feehery-barton-1999** — S. Galán, W. F. Feehery, P. I. Barton: Parametric sensitivity
//!   functions for hybrid discrete/continuous systems. Applied Numerical Mathematics 31(1), 1999,
//!   17–47.
//!
//! <a id="hindmarsh-2005"></a>
//! - **hindmarsh-2005** — A. C. Hindmarsh et al.: SUNDIALS, suite of nonlinear and
//!   differential/algebraic equation solvers. ACM Transactions on Mathematical Software 31(3),
//!   2005, 363–396.
//!
//! <a id="hairer-norsett-wanner-1993"></a>
//! - **hairer-norsett-wanner-1993** — E. Hairer, S. P. Nørsett, G. Wanner: Solving ordinary
//!   differential equations I. Springer, 1993.
//!
//! <a id="hairer-wanner-1996"></a>
//! - **hairer-wanner-1996** — E. Hairer, G. Wanner: Solving ordinary differential equations II.
//!   Springer, 1996.
//!
//! <a id="tarjan-1972"></a>
//! - **tarjan-1972** — R. Tarjan: Depth-first search and linear graph algorithms. SIAM Journal on
//!   Computing 1(2), 1972, 146–160.
//!
//! <a id="dulmage-mendelsohn-1958"></a>
//! - **dulmage-mendelsohn-1958** — A. L. Dulmage, N. S. Mendelsohn: Coverings of bipartite graphs.
//!   Canadian Journal of Mathematics 10, 1958, 517–534.
//!
//! <a id="hopcroft-karp-1973"></a>
//! - **hopcroft-karp-1973** — J. E. Hopcroft, R. M. Karp: An n^5/2 algorithm for maximum matchings
//!   in bipartite graphs. SIAM Journal on Computing 2(4), 1973, 225–231.
//!
//! <a id="carpanzano-maffezzoni-1998"></a>
//! - **carpanzano-maffezzoni-1998** — E. Carpanzano, C. Maffezzoni: Symbolic manipulation
//!   techniques for model simplification in object-oriented modelling of large scale continuous
//!   systems. Mathematics and Computers in Simulation 48(2), 1998, 133–150.
//!
//! <a id="cellier-kofman-2006"></a>
//! - **cellier-kofman-2006** — F. E. Cellier, E. Kofman: Continuous system simulation. Springer,
//!   2006.
//!
//! <a id="pantelides-1988"></a>
//! - **pantelides-1988** — C. C. Pantelides: The consistent initialization of
//!   differential-algebraic systems. SIAM Journal on Scientific and Statistical Computing 9(2),
//!   1988, 213–231.
//!
//! <a id="mattsson-soderlind-1993"></a>
//! - **mattsson-soderlind-1993** — S. E. Mattsson, G. Söderlind: Index reduction in
//!   differential-algebraic equations using dummy derivatives. SIAM Journal on Scientific Computing
//!   14(3), 1993, 677–692.
//!
//! <a id="branin-1972"></a>
//! - **branin-1972** — F. H. Branin: Widely convergent method for finding multiple solutions of
//!   simultaneous nonlinear equations. IBM Journal of Research and Development 16(5), 1972,
//!   504–522.
//!
//! <a id="deuflhard-2011"></a>
//! - **deuflhard-2011** — P. Deuflhard: Newton methods for nonlinear problems. Affine invariance
//!   and adaptive algorithms. Springer, 2011.
//!
//! <a id="nocedal-wright-2006"></a>
//! - **nocedal-wright-2006** — J. Nocedal, S. J. Wright: Numerical optimization. Second edition,
//!   Springer, 2006.
//!
//! <a id="golub-van-loan-2013"></a>
//! - **golub-van-loan-2013** — G. H. Golub, C. F. Van Loan: Matrix computations. Fourth edition,
//!   Johns Hopkins University Press, 2013.
//!
//! <a id="goldberg-1989"></a>
//! - **goldberg-1989** — D. E. Goldberg: Genetic algorithms in search, optimization and machine
//!   learning. Addison-Wesley, 1989.
//!
//! <a id="isidori-1995"></a>
//! - **isidori-1995** — A. Isidori: Nonlinear control systems, 3rd edition. Springer, 1995.
//!
//! <a id="walter-pronzato-1997"></a>
//! - **walter-pronzato-1997** — É. Walter, L. Pronzato: Identification of parametric models from
//!   experimental data. Springer, 1997.
//!
//! <a id="raue-2009"></a>
//! - **raue-2009** — A. Raue, C. Kreutz, T. Maiwald, J. Bachmann, M. Schilling, U. Klingmüller,
//!   J. Timmer: Structural and practical identifiability analysis of partially observed dynamical
//!   models by exploiting the profile likelihood. Bioinformatics 25(15), 2009, 1923–1929.
//!
//! <a id="satterthwaite-1946"></a>
//! - **satterthwaite-1946** — F. E. Satterthwaite: An approximate distribution of estimates of
//!   variance components. Biometrics Bulletin 2(6), 1946, 110–114.
//!
//! <a id="meier-1953"></a>
//! - **meier-1953** — P. Meier: Variance of a weighted mean. Biometrics 9(1), 1953, 59–73.
//!
//! <a id="heinrich-schuster-1996"></a>
//! - **heinrich-schuster-1996** — R. Heinrich, S. Schuster: The regulation of cellular systems.
//!   Chapman & Hall, 1996.
//!
//! <a id="deb-agrawal-1995"></a>
//! - **deb-agrawal-1995** — K. Deb, R. B. Agrawal: Simulated binary crossover for continuous search
//!   space. Complex Systems 9(2), 1995, 115–148.
//!
//! <a id="deb-agrawal-1999"></a>
//! - **deb-agrawal-1999** — K. Deb, S. Agrawal: A niched-penalty approach for constraint handling in
//!   genetic algorithms. Artificial Neural Nets and Genetic Algorithms, Springer, 1999, 235–243.
//!
//! <a id="deb-2002"></a>
//! - **deb-2002** — K. Deb, A. Pratap, S. Agarwal, T. Meyarivan: A fast and elitist multiobjective
//!   genetic algorithm: NSGA-II. IEEE Transactions on Evolutionary Computation 6(2), 2002, 182–197.
//!
//! <a id="mckay-1979"></a>
//! - **mckay-1979** — M. D. McKay, R. J. Beckman, W. J. Conover: A comparison of three methods for
//!   selecting values of input variables in the analysis of output from a computer code.
//!   Technometrics 21(2), 1979, 239–245.
//!
//! <a id="sobol-1967"></a>
//! - **sobol-1967** — I. M. Sobol: On the distribution of points in a cube and the approximate
//!   evaluation of integrals. USSR Computational Mathematics and Mathematical Physics 7(4), 1967,
//!   86–112.
//!
//! <a id="joe-kuo-2008"></a>
//! - **joe-kuo-2008** — S. Joe, F. Y. Kuo: Constructing Sobol sequences with better
//!   two-dimensional projections. SIAM Journal on Scientific Computing 30(5), 2008, 2635–2654.
//!
//! <a id="jansen-1999"></a>
//! - **jansen-1999** — M. J. W. Jansen: Analysis of variance designs for model output. Computer
//!   Physics Communications 117(1–2), 1999, 35–43.
//!
//! <a id="lamboni-2011"></a>
//! - **lamboni-2011** — M. Lamboni, H. Monod, D. Makowski: Multivariate sensitivity analysis to
//!   measure global contribution of input factors in dynamic models. Reliability Engineering &
//!   System Safety 96(4), 2011, 450–459.
//!
//! <a id="tanabe-fukunaga-2014"></a>
//! - **tanabe-fukunaga-2014** — R. Tanabe, A. S. Fukunaga: Improving the search performance of SHADE
//!   using linear population size reduction. IEEE Congress on Evolutionary Computation, 2014,
//!   1658–1665.
//!
//! <a id="hansen-2016"></a>
//! - **hansen-2016** — N. Hansen: The CMA evolution strategy: a tutorial. arXiv:1604.00772, 2016.
//!
//! <a id="auger-hansen-2005"></a>
//! - **auger-hansen-2005** — A. Auger, N. Hansen: A restart CMA evolution strategy with increasing
//!   population size. IEEE Congress on Evolutionary Computation, 2005, 1769–1776.
//!
//! <a id="more-1978"></a>
//! - **more-1978** — J. J. Moré: The Levenberg-Marquardt algorithm: implementation and theory.
//!   Numerical Analysis, Lecture Notes in Mathematics 630, Springer, 1978, 105–116.
//!
//! <a id="transtrum-sethna-2012"></a>
//! - **transtrum-sethna-2012** — M. K. Transtrum, J. P. Sethna: Improvements to the
//!   Levenberg-Marquardt algorithm for nonlinear least-squares minimization. arXiv:1201.5885, 2012.
//!
//! <a id="golub-pereyra-1973"></a>
//! - **golub-pereyra-1973** — G. H. Golub, V. Pereyra: The differentiation of pseudo-inverses and
//!   nonlinear least squares problems whose variables separate. SIAM Journal on Numerical Analysis
//!   10(2), 1973, 413–432.
//!
//! <a id="kaufman-1975"></a>
//! - **kaufman-1975** — L. Kaufman: A variable projection method for solving separable nonlinear
//!   least squares problems. BIT 15, 1975, 49–57.
//!
//! <a id="bates-watts-1981"></a>
//! - **bates-watts-1981** — D. M. Bates, D. G. Watts: A relative offset orthogonality convergence
//!   criterion for nonlinear least squares. Technometrics 23(2), 1981, 179–183.
//!
//! <a id="box-draper-1965"></a>
//! - **box-draper-1965** — G. E. P. Box, N. R. Draper: The Bayesian estimation of common parameters
//!   from several responses. Biometrika 52(3/4), 1965, 355–365.
//!
//! <a id="dempster-laird-rubin-1977"></a>
//! - **dempster-laird-rubin-1977** — A. P. Dempster, N. M. Laird, D. B. Rubin: Maximum likelihood
//!   from incomplete data via the EM algorithm. Journal of the Royal Statistical Society B 39(1),
//!   1977, 1–38.
//!
//! <a id="rao-1967"></a>
//! - **rao-1967** — C. R. Rao: Least squares theory using an estimated dispersion matrix and its
//!   application to measurement of signals. Proceedings of the Fifth Berkeley Symposium on
//!   Mathematical Statistics and Probability 1, 1967, 355–372.
//!
//! <a id="bates-watts-1988"></a>
//! - **bates-watts-1988** — D. M. Bates, D. G. Watts: Nonlinear Regression Analysis and Its
//!   Applications. Wiley, 1988.
//!
//! <a id="boender-rinnooy-kan-1987"></a>
//! - **boender-rinnooy-kan-1987** — C. G. E. Boender, A. H. G. Rinnooy Kan: Bayesian stopping rules
//!   for multistart global optimization methods. Mathematical Programming 37, 1987, 59–80.
//!
//! <a id="nielsen-1999"></a>
//! - **nielsen-1999** — H. B. Nielsen: Damping parameter in Marquardt's method. Report
//!   IMM-REP-1999-05, Technical University of Denmark, 1999.
//!
//! <a id="gao-han-2012"></a>
//! - **gao-han-2012** — F. Gao, L. Han: Implementing the Nelder-Mead simplex algorithm with adaptive
//!   parameters. Computational Optimization and Applications 51(1), 2012, 259–277.
//!
//! <a id="anderson-darling-1952"></a>
//! - **anderson-darling-1952** — T. W. Anderson, D. A. Darling: Asymptotic theory of certain
//!   goodness of fit criteria based on stochastic processes. Annals of Mathematical Statistics
//!   23(2), 1952, 193–212.
//!
//! <a id="durbin-watson-1950"></a>
//! - **durbin-watson-1950** — J. Durbin, G. S. Watson: Testing for serial correlation in least squares
//!   regression. Biometrika 37(3/4), 1950, 409–428.
//!
//! <a id="cook-weisberg-1982"></a>
//! - **cook-weisberg-1982** — R. D. Cook, S. Weisberg: Residuals and influence in regression.
//!   Chapman and Hall, 1982.
//!
//! <a id="seber-wild-1989"></a>
//! - **seber-wild-1989** — G. A. F. Seber, C. J. Wild: Nonlinear regression. Wiley, 1989.
//!
//! <a id="huber-ronchetti-2009"></a>
//! - **huber-ronchetti-2009** — P. J. Huber, E. M. Ronchetti: Robust statistics. 2nd edition,
//!   Wiley, 2009.
//!
//! <a id="lange-1989"></a>
//! - **lange-1989** — K. L. Lange, R. J. A. Little, J. M. G. Taylor: Robust statistical modeling using
//!   the t distribution. Journal of the American Statistical Association 84, 1989, 881–896.
//!
//! <a id="mccullagh-nelder-1989"></a>
//! - **mccullagh-nelder-1989** — P. McCullagh, J. A. Nelder: Generalized linear models. 2nd edition,
//!   Chapman and Hall, 1989.
//!
//! <a id="wald-wolfowitz-1940"></a>
//! - **wald-wolfowitz-1940** — A. Wald, J. Wolfowitz: On a test whether two samples are from the same
//!   population. Annals of Mathematical Statistics 11(2), 1940, 147–162.
//!
//! <a id="morris-1991"></a>
//! - **morris-1991** — M. D. Morris: Factorial sampling plans for preliminary computational
//!   experiments. Technometrics 33(2), 1991, 161–174.
//!
//! <a id="filippov-1988"></a>
//! - **filippov-1988** — A. F. Filippov: Differential equations with discontinuous righthand sides.
//!   Kluwer, 1988.
//!
//! <a id="piiroinen-kuznetsov-2008"></a>
//! - **piiroinen-kuznetsov-2008** — P. T. Piiroinen, Yu. A. Kuznetsov: An event-driven method to
//!   simulate Filippov systems with accurate computing of sliding motions. ACM Transactions on
//!   Mathematical Software 34(3), 2008, 13.
//!
//! <a id="huber-1964"></a>
//! - **huber-1964** — P. J. Huber: Robust estimation of a location parameter. Annals of Mathematical
//!   Statistics 35(1), 1964, 73–101.
//!
//! <a id="fedorov-1972"></a>
//! - **fedorov-1972** — V. V. Fedorov: Theory of optimal experiments. Academic Press, 1972.
//!
//! <a id="demmel-veselic-1992"></a>
//! - **demmel-veselic-1992** — J. Demmel, K. Veselić: Jacobi's method is more accurate than QR. SIAM
//!   Journal on Matrix Analysis and Applications 13(4), 1992, 1204–1245.
//!
//! <a id="efron-tibshirani-1993"></a>
//! - **efron-tibshirani-1993** — B. Efron, R. J. Tibshirani: An introduction to the bootstrap.
//!   Chapman and Hall, 1993.
//!
//! <a id="davison-hinkley-1997"></a>
//! - **davison-hinkley-1997** — A. C. Davison, D. V. Hinkley: Bootstrap methods and their
//!   application. Cambridge University Press, 1997.
//!
//! <a id="haario-2006"></a>
//! - **haario-2006** — H. Haario, M. Laine, A. Mira, E. Saksman: DRAM, efficient adaptive MCMC.
//!   Statistics and Computing 16, 2006, 339–354.
//!
//! <a id="gelman-1996"></a>
//! - **gelman-1996** — A. Gelman, G. O. Roberts, W. R. Gilks: Efficient Metropolis jumping rules.
//!   Bayesian Statistics 5, 1996, 599–607.
//!
//! <a id="gelman-2013"></a>
//! - **gelman-2013** — A. Gelman, J. B. Carlin, H. S. Stern, D. B. Dunson, A. Vehtari, D. B. Rubin:
//!   Bayesian data analysis. 3rd edition, Chapman and Hall, 2013.
//!
//! <a id="vehtari-2021"></a>
//! - **vehtari-2021** — A. Vehtari, A. Gelman, D. Simpson, B. Carpenter, P.-C. Bürkner:
//!   Rank-normalization, folding, and localization: an improved R-hat for assessing convergence of
//!   MCMC. Bayesian Analysis 16(2), 2021, 667–718.
//!
//! <a id="burnham-anderson-2002"></a>
//! - **burnham-anderson-2002** — K. P. Burnham, D. R. Anderson: Model selection and multimodel
//!   inference. 2nd edition, Springer, 2002.
//!
//! <a id="holland-1975"></a>
//! - **holland-1975** — J. H. Holland: Adaptation in natural and artificial systems. University of
//!   Michigan Press, 1975 (one-point crossover).
//!
//! <a id="de-jong-1975"></a>
//! - **de-jong-1975** — K. A. De Jong: An analysis of the behavior of a class of genetic adaptive
//!   systems. Doctoral dissertation, University of Michigan, 1975 (two-point crossover, generation
//!   gap).
//!
//! <a id="syswerda-1989"></a>
//! - **syswerda-1989** — G. Syswerda: Uniform crossover in genetic algorithms. Proceedings of the 3rd
//!   International Conference on Genetic Algorithms, 1989, 2–9.
//!
//! <a id="eshelman-schaffer-1993"></a>
//! - **eshelman-schaffer-1993** — L. J. Eshelman, J. D. Schaffer: Real-coded genetic algorithms and
//!   interval-schemata. Foundations of Genetic Algorithms 2, 1993, 187–202 (BLX-α).
//!
//! <a id="michalewicz-1996"></a>
//! - **michalewicz-1996** — Z. Michalewicz: Genetic algorithms + data structures = evolution
//!   programs. 3rd edition, Springer, 1996 (arithmetical crossover, non-uniform mutation).
//!
//! <a id="baker-1985"></a>
//! - **baker-1985** — J. E. Baker: Adaptive selection methods for genetic algorithms. Proceedings of
//!   the 1st International Conference on Genetic Algorithms, 1985, 101–111 (linear ranking).
//!
//! <a id="baker-1987"></a>
//! - **baker-1987** — J. E. Baker: Reducing bias and inefficiency in the selection algorithm.
//!   Proceedings of the 2nd International Conference on Genetic Algorithms, 1987, 14–21 (stochastic
//!   universal sampling).
//!
//! <a id="goldberg-deb-1991"></a>
//! - **goldberg-deb-1991** — D. E. Goldberg, K. Deb: A comparative analysis of selection schemes
//!   used in genetic algorithms. Foundations of Genetic Algorithms 1, 1991, 69–93.
//!
//! <a id="back-schwefel-1993"></a>
//! - **back-schwefel-1993** — T. Bäck, H.-P. Schwefel: An overview of evolutionary algorithms for
//!   parameter optimization. Evolutionary Computation 1(1), 1993, 1–23.
//!
//! <a id="beyer-schwefel-2002"></a>
//! - **beyer-schwefel-2002** — H.-G. Beyer, H.-P. Schwefel: Evolution strategies, a comprehensive
//!   introduction. Natural Computing 1, 2002, 3–52 ((μ + λ) selection).
//!
//! <a id="mahfoud-1995"></a>
//! - **mahfoud-1995** — S. W. Mahfoud: Niching methods for genetic algorithms. Doctoral dissertation,
//!   University of Illinois at Urbana-Champaign, 1995 (deterministic crowding).
//!
//! <a id="halton-1960"></a>
//! - **halton-1960** — J. H. Halton: On the efficiency of certain quasi-random sequences of points
//!   in evaluating multi-dimensional integrals. Numerische Mathematik 2, 1960, 84–90.
//!
//! <a id="cranley-patterson-1976"></a>
//! - **cranley-patterson-1976** — R. Cranley, T. N. L. Patterson: Randomization of number theoretic
//!   methods for multiple integration. SIAM Journal on Numerical Analysis 13(6), 1976, 904–914.
//!
//! <a id="bartlett-1954"></a>
//! - **bartlett-1954** — M. S. Bartlett: Problèmes de l'analyse spectrale des séries temporelles
//!   stationnaires. Publications de l'Institut de Statistique de l'Université de Paris III-3, 1954,
//!   119–134.
//!
//! <a id="self-liang-1987"></a>
//! - **self-liang-1987** — S. G. Self, K.-Y. Liang: Asymptotic properties of maximum likelihood
//!   estimators and likelihood ratio tests under nonstandard conditions. Journal of the American
//!   Statistical Association 82, 1987, 605–610.
//!
//! <a id="jazwinski-1970"></a>
//! - **jazwinski-1970** — A. H. Jazwinski: Stochastic Processes and Filtering Theory. Academic Press,
//!   1970.
//!
//! <a id="rauch-tung-striebel-1965"></a>
//! - **rauch-tung-striebel-1965** — H. E. Rauch, F. Tung, C. T. Striebel: Maximum likelihood estimates of
//!   linear dynamic systems. AIAA Journal 3(8), 1965, 1445–1450.
//!
//! <a id="bierman-1973"></a>
//! - **bierman-1973** — G. J. Bierman: Fixed interval smoothing with discrete measurements. International
//!   Journal of Control 18(1), 1973, 65–75.
//!
//! <a id="van-loan-1978"></a>
//! - **van-loan-1978** — C. F. Van Loan: Computing integrals involving the matrix exponential. IEEE
//!   Transactions on Automatic Control 23(3), 1978, 395–404.
//!
//! <a id="al-mohy-higham-2009"></a>
//! - **al-mohy-higham-2009** — A. H. Al-Mohy, N. J. Higham: Computing the Fréchet derivative of the
//!   matrix exponential, with an application to condition number estimation. SIAM Journal on Matrix
//!   Analysis and Applications 30(4), 2009, 1639–1657.

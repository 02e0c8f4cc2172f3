within Modelica.Math;
package Matrices "Functions of matrices"
  extends Modelica.Icons.Package;

  function toString "Text of a matrix, a row a line"
    extends Modelica.Icons.Function;
    input Real M[:, :] "matrix";
    input String name = "" "its name";
    input Integer significantDigits = 6 "digits of an element";
    output String s = "" "text";
  algorithm
    s := if name == "" then "" else name + " = \n";
    for i in 1:size(M, 1) loop
      for j in 1:size(M, 2) loop
        s := s + "  " + String(M[i, j], significantDigits = significantDigits, minimumLength = significantDigits + 7);
      end for;
      s := s + "\n";
    end for;
  end toString;

  function isEqual "Whether two matrices are equal within a tolerance"
    extends Modelica.Icons.Function;
    input Real M1[:, :] "matrix";
    input Real M2[:, :] "another";
    input Real eps(min = 0) = 0 "tolerance of an element";
    output Boolean result "whether they are";
  algorithm
    result := size(M1, 1) == size(M2, 1) and size(M1, 2) == size(M2, 2);
    if result then
      for i in 1:size(M1, 1) loop
        for j in 1:size(M1, 2) loop
          result := result and abs(M1[i, j] - M2[i, j]) <= eps;
        end for;
      end for;
    end if;
  end isEqual;

  function LU "Lower and upper triangular factors of a matrix whose rows are exchanged"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real LU[size(A, 1), size(A, 2)] = A "upper factor, and the lower one without its diagonal of ones";
    output Integer pivots[min(size(A, 1), size(A, 2))] "row i was exchanged with row pivots[i]";
    output Integer info = 0 "first i with a zero in place (i, i) of the upper factor; else 0";
  protected
    Integer m = size(A, 1) "number of rows";
    Integer p "row of the pivot";
    Real row[size(A, 2)] "row to be exchanged";
  algorithm
    for k in 1:min(size(A, 1), size(A, 2)) loop
      p := k;
      for i in k + 1:m loop
        if abs(LU[i, k]) > abs(LU[p, k]) then
          p := i;
        end if;
      end for;
      pivots[k] := p;
      if LU[p, k] == 0 then
        info := if info == 0 then k else info;
      else
        row := LU[k, :];
        LU[k, :] := LU[p, :];
        LU[p, :] := row;
        for i in k + 1:m loop
          LU[i, k] := LU[i, k]/LU[k, k];
          for j in k + 1:size(A, 2) loop
            LU[i, j] := LU[i, j] - LU[i, k]*LU[k, j];
          end for;
        end for;
      end if;
    end for;
  end LU;

  function LU_solve "Solution of P L U x = b with the factors of LU"
    extends Modelica.Icons.Function;
    input Real LU[:, size(LU, 1)] "factors";
    input Integer pivots[size(LU, 1)] "exchanged rows";
    input Real b[size(LU, 1)] "right-hand side";
    output Real x[size(b, 1)] = b "solution";
  protected
    Integer n = size(LU, 1) "number of unknowns";
    Real held "element to be exchanged";
  algorithm
    for i in 1:n loop
      assert(LU[i, i] <> 0, "the matrix is singular");
      held := x[i];
      x[i] := x[pivots[i]];
      x[pivots[i]] := held;
    end for;
    for i in 2:n loop
      x[i] := x[i] - LU[i, 1:i - 1]*x[1:i - 1];
    end for;
    for i in n:-1:1 loop
      x[i] := (x[i] - LU[i, i + 1:n]*x[i + 1:n])/LU[i, i];
    end for;
  end LU_solve;

  function LU_solve2 "Solution of P L U X = B with the factors of LU"
    extends Modelica.Icons.Function;
    input Real LU[:, size(LU, 1)] "factors";
    input Integer pivots[size(LU, 1)] "exchanged rows";
    input Real B[size(LU, 1), :] "right-hand sides";
    output Real X[size(B, 1), size(B, 2)] "solutions";
  algorithm
    for j in 1:size(B, 2) loop
      X[:, j] := LU_solve(LU, pivots, B[:, j]);
    end for;
  end LU_solve2;

  function solve "Solution of A x = b"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    input Real b[size(A, 1)] "right-hand side";
    output Real x[size(b, 1)] "solution";
  protected
    Real factors[size(A, 1), size(A, 1)] "factors of the matrix";
    Integer pivots[size(A, 1)] "exchanged rows";
    Integer info "0 unless it is singular";
  algorithm
    (factors, pivots, info) := LU(A);
    assert(info == 0, "the matrix of the linear equations is singular");
    x := LU_solve(factors, pivots, b);
  end solve;

  function solve2 "Solution of A X = B"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    input Real B[size(A, 1), :] "right-hand sides";
    output Real X[size(B, 1), size(B, 2)] "solutions";
  protected
    Real factors[size(A, 1), size(A, 1)] "factors of the matrix";
    Integer pivots[size(A, 1)] "exchanged rows";
    Integer info "0 unless it is singular";
  algorithm
    (factors, pivots, info) := LU(A);
    assert(info == 0, "the matrix of the linear equations is singular");
    X := LU_solve2(factors, pivots, B);
  end solve2;

  function inv "Inverse of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    output Real invA[size(A, 1), size(A, 2)] "inverse";
  algorithm
    invA := solve2(A, identity(size(A, 1)));
  end inv;

  function det "Determinant of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    output Real result "determinant";
  protected
    Real factors[size(A, 1), size(A, 1)] "factors of the matrix";
    Integer pivots[size(A, 1)] "exchanged rows";
  algorithm
    (factors, pivots) := LU(A);
    result := 1;
    for i in 1:size(A, 1) loop
      result := if pivots[i] == i then result*factors[i, i] else -result*factors[i, i];
    end for;
  end det;

  function trace "Sum of the diagonal of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    output Real result "sum";
  algorithm
    result := sum(A[i, i] for i in 1:size(A, 1));
    annotation(Inline = true);
  end trace;

  function norm "Norm of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    input Real p(min = 1) = 2
      "1: greatest sum of a column, 2: greatest singular value, Modelica.Constants.inf: greatest sum of a row";
    output Real result "norm";
  algorithm
    assert(p == 1 or p == 2 or p >= Modelica.Constants.inf,
      "the p of the norm of a matrix is 1, 2 or Modelica.Constants.inf");
    result := 0;
    if p == 1 then
      for j in 1:size(A, 2) loop
        result := max(result, sum(abs(A[:, j])));
      end for;
    elseif p == 2 then
      for sigma in lengthsOfOrthogonalColumns(A) loop
        result := max(result, sigma);
      end for;
    else
      for i in 1:size(A, 1) loop
        result := max(result, sum(abs(A[i, :])));
      end for;
    end if;
  end norm;

  function lengthsOfOrthogonalColumns
    "Singular values, not sorted: lengths of the columns after rotations that make them orthogonal"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real sigma[size(A, 2)] "singular values, and zeros for more columns than rows";
  protected
    Real W[size(A, 1), size(A, 2)] = A "columns";
    Real column[size(A, 1)] "column to be rotated";
    Real a, b, g "products of two columns";
    Real t, c, s "tangent, cosine and sine of a rotation";
    Boolean rotated = true "whether the last sweep rotated";
    Integer sweeps = 0 "number of sweeps";
  algorithm
    // One-sided method of Jacobi (Hestenes 1958).
    while rotated and sweeps < 60 loop
      rotated := false;
      sweeps := sweeps + 1;
      for i in 1:size(A, 2) - 1 loop
        for j in i + 1:size(A, 2) loop
          a := W[:, i]*W[:, i];
          b := W[:, j]*W[:, j];
          g := W[:, i]*W[:, j];
          if abs(g) > 4*Modelica.Constants.eps*sqrt(a*b) then
            rotated := true;
            t := (b - a)/(2*g);
            t := (if t < 0 then -1 else 1)/(abs(t) + sqrt(1 + t*t));
            c := 1/sqrt(1 + t*t);
            s := c*t;
            column := W[:, i];
            W[:, i] := c*column - s*W[:, j];
            W[:, j] := s*column + c*W[:, j];
          end if;
        end for;
      end for;
    end while;
    sigma := {sqrt(W[:, j]*W[:, j]) for j in 1:size(A, 2)};
  end lengthsOfOrthogonalColumns;

  function frobeniusNorm "Root of the sum of the squared elements"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real result "root";
  algorithm
    result := sqrt(sum(A.*A));
    annotation(Inline = true);
  end frobeniusNorm;

  function cholesky "Triangular factor of a symmetric positive definite matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    input Boolean upper = true "A = H'*H with an upper factor H, else A = H*H'";
    output Real H[size(A, 1), size(A, 2)] = zeros(size(A, 1), size(A, 1)) "factor";
  protected
    Real square "square of an element of the diagonal";
  algorithm
    for j in 1:size(A, 1) loop
      square := A[j, j] - H[j, 1:j - 1]*H[j, 1:j - 1];
      assert(square > 0, "the matrix is not positive definite");
      H[j, j] := sqrt(square);
      for i in j + 1:size(A, 1) loop
        H[i, j] := (A[i, j] - H[i, 1:j - 1]*H[j, 1:j - 1])/H[j, j];
      end for;
    end for;
    if upper then
      H := transpose(H);
    end if;
  end cholesky;

  function leastSquares "The x of least |A x - b| where the columns of A are independent"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix with at least as many rows as columns";
    input Real b[size(A, 1)] "right-hand side";
    input Real rcond = 100*Modelica.Constants.eps "columns with a smaller relative remainder are dependent";
    output Real x[size(A, 2)] "solution";
    output Integer rank "number of columns";
  protected
    Integer n = size(A, 2) "number of unknowns";
    Real Q[size(A, 1), size(A, 2)] = A "columns made orthogonal";
    Real R[size(A, 2), size(A, 2)] = zeros(size(A, 2), size(A, 2)) "upper triangular factor";
    Real left[size(A, 1)] = b "what is left of the right-hand side";
    Real y[size(A, 2)] "right-hand side of the triangular system";
  algorithm
    for j in 1:n loop
      R[j, j] := sqrt(Q[:, j]*Q[:, j]);
      assert(R[j, j] > rcond*sqrt(A[:, j]*A[:, j]), "the columns of the matrix are dependent");
      Q[:, j] := Q[:, j]/R[j, j];
      for k in j + 1:n loop
        R[j, k] := Q[:, j]*Q[:, k];
        Q[:, k] := Q[:, k] - R[j, k]*Q[:, j];
      end for;
      y[j] := Q[:, j]*left;
      left := left - y[j]*Q[:, j];
    end for;
    for i in n:-1:1 loop
      x[i] := (y[i] - R[i, i + 1:n]*x[i + 1:n])/R[i, i];
    end for;
    rank := n;
  end leastSquares;

  function exp "Exponential function of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    input Real T = 1 "factor of the matrix";
    output Real phi[size(A, 1), size(A, 1)] "exp(A*T)";
  protected
    Integer doublings "how often the series is squared";
    Real S[size(A, 1), size(A, 1)] "matrix over a power of two, of a norm below 1/2";
    Real term[size(A, 1), size(A, 1)] "term of the series";
  algorithm
    assert(norm(A, 1)*abs(T) < Modelica.Constants.inf, "the matrix is too large for an exponential function");
    doublings := 0;
    while norm(A, 1)*abs(T) >= 2.0^(doublings - 1) loop
      doublings := doublings + 1;
    end while;
    S := A*(T/2.0^doublings);
    phi := identity(size(A, 1));
    term := identity(size(A, 1));
    // The remainder behind the term k is less than twice 0.5^(k + 1)/(k + 1)!.
    for k in 1:17 loop
      term := term*S/k;
      phi := phi + term;
    end for;
    for i in 1:doublings loop
      phi := phi*phi;
    end for;
  end exp;

  function flipLeftRight "The columns from last to first"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real Aflip[size(A, 1), size(A, 2)] "flipped matrix";
  algorithm
    Aflip := A[:, {size(A, 2) + 1 - i for i in 1:size(A, 2)}];
    annotation(Inline = true);
  end flipLeftRight;

  function flipUpDown "The rows from last to first"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real Aflip[size(A, 1), size(A, 2)] "flipped matrix";
  algorithm
    Aflip := A[{size(A, 1) + 1 - i for i in 1:size(A, 1)}, :];
    annotation(Inline = true);
  end flipUpDown;

  function eigenValues "Eigenvalues and right eigenvectors of a matrix"
    extends Modelica.Icons.Function;
    input Real A[:, size(A, 1)] "matrix";
    output Real eigenvalues[size(A, 1), 2] "real and imaginary parts, a row each";
    output Real eigenvectors[size(A, 1), size(A, 2)] "columns; of a conjugate pair the real part, then the imaginary part";
  protected
    Integer info "0: found";
    Real re[size(A, 1)] "real parts";
    Real im[size(A, 1)] "imaginary parts";
  algorithm
    if size(A, 1) > 0 then
      (re, im, eigenvectors, info) := LAPACK.dgeev(A);
      assert(info == 0, "the eigenvalues are not found: the iteration does not converge");
      eigenvalues[:, 1] := re;
      eigenvalues[:, 2] := im;
    end if;
  end eigenValues;

  function singularValues "Singular values and vectors of a matrix, A = U*S*VT"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    output Real sigma[min(size(A, 1), size(A, 2))] "singular values, the largest first";
    output Real U[size(A, 1), size(A, 1)] = identity(size(A, 1)) "left singular vectors, in columns";
    output Real VT[size(A, 2), size(A, 2)] = identity(size(A, 2)) "right singular vectors, in rows";
  protected
    Integer info "0: found";
  algorithm
    if min(size(A, 1), size(A, 2)) > 0 then
      (sigma, U, VT, info) := LAPACK.dgesvd(A);
      assert(info == 0, "the singular values are not found: the iteration does not converge");
    end if;
  end singularValues;

  function QR "Orthogonal and triangular factors of a matrix with at least as many rows as columns"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    input Boolean pivoting = true "whether columns are exchanged";
    output Real Q[size(A, 1), size(A, 2)] "orthonormal columns: Q*R = A[:, p]";
    output Real R[size(A, 2), size(A, 2)] "upper triangle";
    output Integer p[size(A, 2)] "columns of A in the order in which they are taken";
  protected
    Integer n = size(A, 2) "number of columns";
    Real packed[size(A, 1), size(A, 2)] "R and the reflections below it";
    Real tau[size(A, 2)] "factors of the reflections";
  algorithm
    assert(size(A, 1) >= n, "QR needs a matrix with at least as many rows as columns");
    if n > 0 then
      if pivoting then
        (packed, tau, p) := LAPACK.dgeqp3(A);
      else
        (packed, tau) := LAPACK.dgeqrf(A);
        p := 1:n;
      end if;
      Q := LAPACK.dorgqr(packed, tau);
      for i in 1:n loop
        for j in 1:n loop
          R[i, j] := if j >= i then packed[i, j] else 0;
        end for;
      end for;
    end if;
  end QR;

  function rank "Number of singular values that are not negligible"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    input Real eps = 0 "a singular value up to this counts as zero; if not positive, max(size(A))*norm(A)*Modelica.Constants.eps";
    output Integer result "rank";
  protected
    Real sigma[min(size(A, 1), size(A, 2))] "singular values";
    Real bound "what counts as zero";
  algorithm
    result := 0;
    if min(size(A, 1), size(A, 2)) > 0 then
      sigma := singularValues(A);
      bound := if eps > 0 then eps else max(size(A))*sigma[1]*Modelica.Constants.eps;
      for i in 1:size(sigma, 1) loop
        result := if sigma[i] > bound then result + 1 else result;
      end for;
    end if;
  end rank;

  function conditionNumber "Ratio of the largest and the smallest singular value"
    extends Modelica.Icons.Function;
    input Real A[:, :] "matrix";
    input Real p(min = 1) = 2 "the norm: 1, 2 or Modelica.Constants.inf; any other than 2 of regular square matrices only";
    output Real result "condition number; Modelica.Constants.inf of a singular matrix";
  protected
    Real sigma[min(size(A, 1), size(A, 2))] "singular values";
  algorithm
    if min(size(A, 1), size(A, 2)) == 0 then
      result := 0;
    elseif p == 2 then
      sigma := singularValues(A);
      result := if sigma[size(sigma, 1)] > 0 then sigma[1]/sigma[size(sigma, 1)] else Modelica.Constants.inf;
    else
      result := norm(A, p)*norm(inv(A), p);
    end if;
  end conditionNumber;

  package LAPACK "Routines of LAPACK that the functions above call"
    extends Modelica.Icons.Package;

    function dgeev "Eigenvalues and right eigenvectors"
      extends Modelica.Icons.Function;
      input Real A[:, size(A, 1)] "matrix";
      output Real eigenReal[size(A, 1)] "real parts";
      output Real eigenImag[size(A, 1)] "imaginary parts";
      output Real eigenVectors[size(A, 1), size(A, 1)] "right eigenvectors";
      output Integer info "0: found";
    protected
      Integer n = size(A, 1) "order";
      Integer lwork = 12*size(A, 1) "size of the work space";
      Real work[12*size(A, 1)] "work space";
      Real reduced[size(A, 1), size(A, 1)] = A "overwritten";
      Real left[size(A, 1), size(A, 1)] "left eigenvectors, not wanted";
      external "FORTRAN 77" dgeev("N", "V", n, reduced, n, eigenReal, eigenImag, left, n, eigenVectors, n, work, lwork, info);
    end dgeev;

    function dgesvd "Singular values and vectors"
      extends Modelica.Icons.Function;
      input Real A[:, :] "matrix";
      output Real sigma[min(size(A, 1), size(A, 2))] "singular values";
      output Real U[size(A, 1), size(A, 1)] "left singular vectors";
      output Real VT[size(A, 2), size(A, 2)] "right singular vectors, in rows";
      output Integer info "0: found";
    protected
      Integer m = size(A, 1) "rows";
      Integer n = size(A, 2) "columns";
      Integer lwork = 5*size(A, 1) + 5*size(A, 2) "size of the work space";
      Real work[5*size(A, 1) + 5*size(A, 2)] "work space";
      Real reduced[size(A, 1), size(A, 2)] = A "overwritten";
      external "FORTRAN 77" dgesvd("A", "A", m, n, reduced, m, sigma, U, m, VT, n, work, lwork, info);
    end dgesvd;

    function dgeqp3 "Factors of a matrix whose columns are exchanged"
      extends Modelica.Icons.Function;
      input Real A[:, :] "matrix";
      output Real QR[size(A, 1), size(A, 2)] = A "upper triangle, and reflections below it";
      output Real tau[min(size(A, 1), size(A, 2))] "factors of the reflections";
      output Integer p[size(A, 2)] = zeros(size(A, 2)) "order of the columns";
      output Integer info "0: found";
    protected
      Integer m = size(A, 1) "rows";
      Integer n = size(A, 2) "columns";
      Integer lwork = 3*size(A, 2) + 3 "size of the work space";
      Real work[3*size(A, 2) + 3] "work space";
      external "FORTRAN 77" dgeqp3(m, n, QR, m, p, tau, work, lwork, info);
    end dgeqp3;

    function dgeqrf "Factors of a matrix"
      extends Modelica.Icons.Function;
      input Real A[:, :] "matrix";
      output Real QR[size(A, 1), size(A, 2)] = A "upper triangle, and reflections below it";
      output Real tau[min(size(A, 1), size(A, 2))] "factors of the reflections";
      output Integer info "0: found";
    protected
      Integer m = size(A, 1) "rows";
      Integer n = size(A, 2) "columns";
      Integer lwork = 3*size(A, 2) + 3 "size of the work space";
      Real work[3*size(A, 2) + 3] "work space";
      external "FORTRAN 77" dgeqrf(m, n, QR, m, tau, work, lwork, info);
    end dgeqrf;

    function dorgqr "The orthonormal columns of a factorization"
      extends Modelica.Icons.Function;
      input Real QR[:, :] "of dgeqp3 or dgeqrf";
      input Real tau[min(size(QR, 1), size(QR, 2))] "of dgeqp3 or dgeqrf";
      output Real Q[size(QR, 1), size(QR, 2)] = QR "orthonormal columns";
      output Integer info "0: found";
    protected
      Integer m = size(QR, 1) "rows";
      Integer n = size(QR, 2) "columns";
      Integer k = size(tau, 1) "reflections";
      Integer lwork = 3*size(QR, 2) + 3 "size of the work space";
      Real work[3*size(QR, 2) + 3] "work space";
      external "FORTRAN 77" dorgqr(m, n, k, Q, m, tau, work, lwork, info);
    end dorgqr;
  end LAPACK;
  annotation(Documentation(info = "<html>
<p>Linear equations, least squares, determinants, norms and the exponential function are written in
Modelica; eigenvalues, singular values and orthogonal factors are those of LAPACK. Matrix equations
are not here.</p>
</html>"));
end Matrices;

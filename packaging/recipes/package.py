# Spack: var/spack/repos/builtin/packages/gapi/package.py
from spack.package import *


class Gapi(Package):
    """Identifies the parameters of Modelica models from measured data; compiles and simulates Modelica
    models natively."""

    homepage = "@REPOSITORY@"
    url = "@REPOSITORY@/archive/refs/tags/v@VERSION@.tar.gz"

    license("MIT OR Apache-2.0")

    version("@VERSION@", sha256="@SHA256@")

    variant("mpi", default=False, description="Distribute populations over the ranks of an MPI job")

    depends_on("c", type="build")
    depends_on("rust@@RUST@:", type="build")
    depends_on("mpi", when="+mpi")
    depends_on("llvm+clang", type="build", when="+mpi")

    def install(self, spec, prefix):
        cargo = which("cargo", required=True)
        features = ["--features", "mpi"] if spec.satisfies("+mpi") else []
        cargo("build", "--release", "--locked", "-p", "gapilib", "-p", "gapilib-fmu", *features)
        Executable("packaging/install")("target/release", prefix)

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def check_install(self):
        Executable(self.prefix.bin.gapi)("--version")

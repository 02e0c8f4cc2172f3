# Nix: pkgs.callPackage ./package.nix { }
{ lib, rustPlatform, fetchzip }:

rustPlatform.buildRustPackage rec {
  pname = "gapi";
  version = "@VERSION@";

  src = fetchzip {
    url = "@REPOSITORY@/archive/refs/tags/v${version}.tar.gz";
    # Of the unpacked archive: `nix-prefetch-url --unpack` prints it.
    hash = lib.fakeHash;
  };
  cargoLock.lockFile = "${src}/Cargo.lock";

  cargoBuildFlags = [ "-p" "gapilib" "-p" "gapilib-fmu" ];
  # The whole suite needs programs that a sandbox does not have.
  doCheck = false;
  postInstall = ''
    bash packaging/install target/*/release "$out"
  '';

  meta = {
    description = "Identifies the parameters of Modelica models from measured data";
    homepage = "@REPOSITORY@";
    license = with lib.licenses; [ mit asl20 ];
    mainProgram = "gapi";
  };
}

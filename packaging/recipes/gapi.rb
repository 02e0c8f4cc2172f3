# Homebrew: Formula/gapi.rb
class Gapi < Formula
  desc "Identifies the parameters of Modelica models from measured data"
  homepage "@REPOSITORY@"
  url "@REPOSITORY@/archive/refs/tags/v@VERSION@.tar.gz"
  sha256 "@SHA256@"
  license any_of: ["MIT", "Apache-2.0"]

  depends_on "rust" => :build

  def install
    system "cargo", "build", "--release", "--locked", "-p", "gapilib", "-p", "gapilib-fmu"
    system "packaging/install", "target/release", prefix
  end

  test do
    assert_match version.to_s, shell_output("#{bin}/gapi --version")
    (testpath/"Decay.mo").write <<~MODELICA
      model Decay Real x(start = 1, fixed = true); equation der(x) = -x; end Decay;
    MODELICA
    system bin/"gapi", "simulate", "Decay.mo", "--model", "Decay", "--stop-time", "1"
  end
end

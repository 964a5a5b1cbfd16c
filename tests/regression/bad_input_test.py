"""Wrong input gives one line, exit code 2, and writes nothing."""

import subprocess
from pathlib import Path

from program import PROGRAM, ROOT, check, fresh

CASE = ROOT / "cases" / "tunnel_elastic" / "case.toml"
OUT = fresh("results")


def expect_complaint(words, *fragments):
    done = subprocess.run([PROGRAM, *map(str, words)], check=False, capture_output=True, text=True, timeout=60)
    said = done.stderr
    check(done.returncode == 2, f"{words}: exit {done.returncode} instead of 2: {said}")
    check(said.count("\n") == 1, f"{words}: not one line: {said}")
    for fragment in fragments:
        check(fragment in said, f"{words}: '{fragment}' is missing in: {said}")
    check(not OUT.exists(), f"{words}: something was written")
    print(f"ok: {said.strip()}")


def with_line(text, name="bad.toml"):
    """The case with a line appended; returns its path."""
    Path(name).write_text(CASE.read_text() + "\n" + text + "\n")
    return name


def run_with(setting):
    return ["run", CASE, "-o", OUT, "--set", setting]


lines = CASE.read_text().count("\n") + 3
expect_complaint(["run", with_line("[soil]\nfrictoin = '30 deg'"), "-o", OUT], f"bad.toml:{lines}", "frictoin")
expect_complaint(
    ["check", with_line("[soil]\nsize_minimum = '-2 mm'")], "bad.toml", "size_minimum", "at least 0.001 mm"
)
expect_complaint(["run", with_line("[soil]\nmodulus = '3 mm'"), "-o", OUT], "bad.toml", "modulus", "length")
expect_complaint(["run", with_line("[soil]\nmodulus = 3"), "-o", OUT], "bad.toml", "modulus")
expect_complaint(["run", with_line("this is no TOML"), "-o", OUT], "bad.toml")
expect_complaint(["run", "no_such_case.toml", "-o", OUT], "no_such_case.toml")
expect_complaint(run_with("ground.diameter=-5 m"), "ground.diameter", "at least 1 cm")
expect_complaint(run_with("ground.diameter=5 kPa"), "ground.diameter", "pressure")
expect_complaint(run_with("ground.depth=5 m"), "ground.depth", "unknown")
expect_complaint(run_with("ground.cover_ratio=6"), "ground.cover_ratio", "invert")
expect_complaint(run_with("ground.surcharge=2 kPa"), "ground.surcharge", "packing.pressure")
expect_complaint(run_with("elastic.poisson=0.5"), "elastic.poisson")
expect_complaint(run_with("volume_loss.increments=0"), "volume_loss.increments")
expect_complaint(run_with("volume_loss.total=100 %"), "volume_loss.total")
expect_complaint(run_with("packing.grains=two"), "packing.grains")
expect_complaint(run_with("output.rves=[3, 3]"), "output.rves", "twice")
expect_complaint(run_with("output.rves=[1000000]"), "output.rves", "1000000")
expect_complaint(["check", CASE, "--set", "output.rves=[1000000]"], "output.rves", "1000000")
expect_complaint(run_with('output.fields=["stress", "strian"]'), "output.fields", "strian")
expect_complaint(run_with("title=../elsewhere"), "title")
expect_complaint(run_with("kind=tunel"), "kind", "tunnel")
Path("bad_particles.csv").write_text("id,x_m,y_m,r_m,theta_z_rad\n0,nowhere,0,0.001,0\n")
Path("bad_meta.json").write_text('{"hSize": [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]}')
Path("bad_packing.h5").write_text("no packing")
for name in ("bad_particles.csv", "bad_packing.h5"):
    for words in (["check", CASE], ["run", CASE, "-o", OUT]):
        expect_complaint([*words, "--set", f"packing.file={Path(name).absolute()}"], "packing.file", name)
expect_complaint(run_with("no_equals_sign"), "no_equals_sign")
expect_complaint(["run", CASE, "-o", CASE.parent], "no results of this program")
expect_complaint(["run", CASE, "-o", OUT, "--threads", "0"], "--threads")
expect_complaint(["run", CASE, "-o", OUT, "--resume", "--replace"], "--re")
expect_complaint(["walk", CASE], "unknown command walk")
expect_complaint([])
expect_complaint(["info", CASE], "case.toml")
Path("sweep.toml").write_text(f"base = '{CASE}'\n[[run]]\nname = 'a'\nset = ['ground.diametre=4 m']\n")
expect_complaint(["sweep", "sweep.toml", "-o", OUT], "ground.diametre")
Path("sweep.toml").write_text(f"base = '{CASE}'\n[[run]]\nname = 'a'\n[[run]]\nname = 'a'\n")
expect_complaint(["sweep", "sweep.toml", "-o", OUT], "name")
Path("sweep.toml").write_text(f"base = '{CASE}'\n[[run]]\nname = 'a,b'\n")
expect_complaint(["sweep", "sweep.toml", "-o", OUT], "name", "letters")

"""tools/report in a real browser without a screen and without a network: the page of an ensemble and of a sweep opens
without an error and without a request; every field, every set and the ends of the slider are drawn; a clicked point has
the numbers of the result files; bands are the ensemble's; damaged and unfinished runs are told at the top."""

import importlib.util
import json
import re
import shutil
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import tiny_scene
from program import PROGRAM, ROOT, SMALL_TUNNEL, check, fresh, run

sys.path.insert(0, str(ROOT / "python"))
from voussoir.report import pack

CHROMIUM = shutil.which("chromium")
if CHROMIUM is None or importlib.util.find_spec("playwright") is None:
    print("skipped: Chromium or Playwright is missing; tools/setup --test installs them")
    sys.exit(77)
from playwright.sync_api import sync_playwright  # noqa: E402 - only where it is installed

CASE = ROOT / "cases/tunnel_quick/case.toml"
FURTHER = ["packing.grains=60", "volume_loss.increments=2", "gravity.uniform_step=0.5", "output.rves=[]"]
SETTINGS = [*SMALL_TUNNEL, *FURTHER]
# (field of the page, data set, component, factor to the page's unit)
COMPARED = [
    ("deviatoric_strain", "gauss/deviatoric_strain", 0, 100),
    ("void_ratio", "gauss/void_ratio", 0, 1),
    ("stress_yy", "gauss/stress", 1, -1e-3),
    ("stress_xy", "gauss/stress", 2, 1e-3),
    ("mean_stress", "gauss/mean_stress", 0, 1e-3),
]


def report(folder, output, *further, code=0):
    """Makes a page; returns what was said, the standard error included."""
    done = run([str(ROOT / "tools/report"), str(folder), "-o", str(output), *further], code=code)
    said = done.stdout + done.stderr
    check("Traceback" not in said, f"{folder}: a traceback: {said}")
    check(said.count("\n") == 1, f"{folder}: not one line but {said}")
    return said


def make_results():
    """An ensemble of two tiny tunnels, a copy of a member whose increments say that they are not converged and of which
    one file is damaged, and a sweep of the ensemble, a single run and a run that failed."""
    fresh("sweep")
    words = [PROGRAM, "ensemble", str(CASE), "-n", "2", "-o", "sweep/tunnels/cover_2"]
    run([*words, *(word for setting in SETTINGS for word in ("--set", setting))])
    shutil.copytree("sweep/tunnels/cover_2/member_001", "sweep/tunnels/cover_3")
    shutil.copytree("sweep/tunnels/cover_2/member_000", fresh("damaged"))
    with h5py.File("damaged/run.h5", "r+") as file:
        del file["table/converged"]
        file["table/converged"] = np.array([1] * (len(file["table/index"]) - 1) + [0])
        file["table/cuts"][-2] = 3
    (Path("damaged") / "run.lock").write_text("host here process 1")
    files = sorted(Path("damaged/increments").iterdir())
    files[-2].write_bytes(files[-2].read_bytes()[:3000])
    write_sweep()


def write_sweep():
    """sweep.h5 as `voussoir sweep` writes it (docs/reference/files.md)."""
    names = [f"tunnels/cover_2/member_{k:03d}" for k in (0, 1)] + ["tunnels/cover_3", "tunnels/cover_9"]
    settlements = []
    for name in names[:3]:
        with h5py.File(Path("sweep") / name / "run.h5") as file:
            settlements.append(file["table/surface_settlement"][-1])
    texts = {
        "name": names,
        "status": ["finished"] * 3 + ["no equilibrium"],
        "reason": [""] * 3 + ["no equilibrium at V_l = 1 %"],
        "kind": ["tunnel"] * 4,
        "grid": ["tunnels"] * 4,
        "point": ["cover_2", "cover_2", "cover_3", "cover_9"],
    }
    with h5py.File("sweep/sweep.h5", "w") as file:
        file.attrs["format"], file.attrs["format_version"] = np.bytes_(b"voussoir sweep"), 1
        file["input"] = "[grid]\n"
        for name, values in texts.items():
            file.create_dataset(f"runs/{name}", data=values, dtype=h5py.string_dtype())
        file["runs/exit_code"] = np.array([0, 0, 0, 3])
        file["runs/wall_s"] = np.array([1.0, 2.0, 3.0, np.nan])
        file.create_dataset("axes/cover_ratio", data=["2", "2", "3", "9"], dtype=h5py.string_dtype())
        file["results/surface_settlement"] = np.array([*settlements, np.nan])
        file["results/surface_settlement"].attrs["unit"] = np.bytes_(b"m")
        file.create_dataset("ensembles/name", data=["tunnels/cover_2"], dtype=h5py.string_dtype())


class Opened:
    """A page in the browser; errors and requests are collected."""

    def __init__(self, browser, path, width=1300):
        self.problems: list[str] = []
        self.page = browser.new_page(viewport={"width": width, "height": 900})
        self.page.on("console", lambda message: self.problems.append(f"console: {message.text}"))
        self.page.on("pageerror", lambda error: self.problems.append(f"error: {error}"))
        self.page.on("request", self._asked)
        self.page.goto(Path(path).resolve().as_uri())
        self.page.wait_for_selector("body[data-ready]", timeout=20000)
        self.evaluate = self.page.evaluate

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:")):
            self.problems.append(f"request: {request.url}")

    def end(self, what):
        wide = self.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        check(wide <= 0, f"{what}: the page is {wide} px wider than its window")
        check(not self.problems, f"{what}: {self.problems}")
        self.page.close()

    def choose(self, label, value):
        self.page.get_by_label(label, exact=True).select_option(value)

    def slide(self, frame):
        self.page.locator("input[type=range]").fill(str(frame))

    def warnings(self):
        return self.page.locator(".warnings").inner_text() if self.page.locator(".warnings").count() else ""


def fields_of(group, kind=None):
    """A data set of an increment, or of an ensemble's fields, as (point, component)."""
    data = group[()] if kind is None else group[kind][()]
    return data.reshape(data.shape[0] * data.shape[1], -1)


def check_ensemble(browser, width):
    opened = Opened(browser, "ensemble.html", width)
    fields = opened.evaluate("report.views[0].ground.fields.map(f => f.name)")
    sets = opened.evaluate("report.views[0].sets.length")
    last = opened.evaluate("report.views[0].ground.loads.length") - 1
    check(sets == 3 and last == 2 and len(fields) >= 13, f"sets {sets}, frames {last + 1}, fields {fields}")
    if width > 1000:
        check_every_field(opened, fields, last)
    point = click_a_point(opened)
    for frame in (0, last):
        opened.slide(frame)
        check_numbers(opened, point, frame)
    check_bands(opened, last)
    slow = opened.evaluate("report.views[0].times.slice().sort((a, b) => a - b)[report.views[0].times.length >> 1]")
    after = opened.evaluate("report.readyAfter")
    opened.page.screenshot(path=f"ensemble_{width}.png")
    opened.end(f"ensemble at {width} px")
    return after, slow


def check_every_field(opened, fields, last):
    """Every field of every set at both ends of the slider: the canvas changes, and has more than one colour."""
    seen = set()
    for chosen in range(3):
        opened.choose("show", str(chosen))
        for field in fields:
            opened.choose("field", field)
            for frame in (0, last):
                opened.slide(frame)
            values = opened.evaluate("Array.from(report.views[0].values).filter(Number.isFinite).length")
            known = opened.evaluate(f"{json.dumps(field)} in report.views[0].shown.limits")
            check((values > 0) == known, f"set {chosen}, {field}: {values} values, limits: {known}")
            seen.add(opened.evaluate("report.views[0].canvas.toDataURL()"))
    check(len(seen) > 2 * len(fields), f"{len(seen)} different pictures of {3 * len(fields)}")
    opened.choose("show", "2")


def click_a_point(opened):
    """Clicks the middle of a Gauss point's quarter in the canvas, and returns the point that the page has taken."""
    wanted = 37
    x, y = opened.evaluate(
        f"""(() => {{ const v = report.views[0], c = v.corners.subarray(8 * {wanted}, 8 * {wanted} + 8);
        return v.toCanvas((c[0] + c[2] + c[4] + c[6]) / 4, (c[1] + c[3] + c[5] + c[7]) / 4); }})()"""
    )
    opened.page.locator("canvas").click(position={"x": x, "y": y})
    taken = opened.evaluate("report.views[0].point")
    check(taken == wanted, f"a click on point {wanted} took {taken}")
    return taken


def check_numbers(opened, point, frame):
    """The numbers of the clicked point in the page's table beside those of the files."""
    data = opened.evaluate("report.data.ground")
    (member,) = re.findall(r"member_\d+", data["sets"][2]["title"])
    folder = Path("sweep/tunnels/cover_2")
    with h5py.File(folder / "ensemble.h5") as file:
        rows = np.flatnonzero(file["table/stage"][()] == b"volume_loss")
        index = int(file["table/index"][rows[frame]])
    with (
        h5py.File(folder / member / f"increments/{index:04d}.h5") as single,
        h5py.File(folder / f"fields/{index:04d}.h5") as reduced,
    ):
        for field, name, component, factor in COMPARED:
            shown = opened.page.locator(f"tr[data-field={field}] td[data-value]").evaluate_all(
                "cells => cells.map(cell => Number(cell.dataset.value))"
            )
            wanted = [
                factor * fields_of(reduced[name], "mean")[point, component],
                abs(factor) * fields_of(reduced[name], "mean_half_width")[point, component],
                factor * fields_of(single[name])[point, component],
            ]
            for k, (found, value) in enumerate(zip(shown, wanted)):
                bound = abs(factor) * pack.quantum(data["sets"][k]["blobs"][field], value / factor)
                check(abs(found - value) <= bound, f"{field}, set {k}, frame {frame}: {found}, the file has {value}")


def check_bands(opened, last):
    """The settlement of the surface on the page, with its half width, beside the ensemble's own curve."""
    charts = opened.evaluate("report.charts.map(c => [c.spec.title, c.drawn])")
    with h5py.File("sweep/tunnels/cover_2/ensemble.h5") as file:
        rows = np.flatnonzero(file["table/stage"][()] == b"volume_loss")
        bands = {name: file[f"trough/settlement/{name}"][rows] for name in ("mean", "mean_half_width")}
        reaction = {name: file[f"curves/ground_reaction/{name}"][rows] for name in ("mean", "mean_half_width")}
    trough, settlement, ground = (drawn for _, drawn in charts)
    for name, key in (("mean", "y"), ("mean_half_width", "band")):
        shown = trough[0][key]
        np.testing.assert_allclose(shown, 1e3 * bands[name][last], atol=2e-3 * np.abs(1e3 * bands["mean"]).max())
        np.testing.assert_allclose(settlement[0][key], 1e3 * bands[name][:, 0], rtol=1e-3, atol=1e-3)
        np.testing.assert_allclose(ground[-1][key], reaction[name], rtol=1e-3, atol=1e-4)


def check_sweep(browser):
    opened = Opened(browser, "sweep.html")
    told = opened.warnings()
    check("FAILED: tunnels/cover_9 (no equilibrium, exit status 3): no equilibrium at V_l = 1 %" in told, told)
    with h5py.File("sweep/sweep.h5") as file:
        both = file["results/surface_settlement"][:2]
    cells = opened.page.locator("tr[data-point='tunnels/cover_2'] td").all_inner_texts()
    half = 12.706204736 * both.std(ddof=1) / np.sqrt(2)
    check(abs(float(cells[2]) - both.mean()) < 1e-3 * both.mean(), f"{cells} instead of {both.mean()}")
    check(abs(float(cells[3]) - half) < 1e-3 * half, f"{cells} instead of {half}")
    for label in ("against", "colour"):
        for value in ("point", "cover_ratio"):
            opened.choose(label, value)
    check(opened.page.locator("[data-group] svg path").count() >= 4, "the curves of the points are not drawn")
    opened.choose("point", "tunnels/cover_3")
    opened.page.wait_for_function("report.views[0] && report.views[0].sets[0].title === 'cover_3'")
    opened.slide(0)
    opened.page.screenshot(path="sweep.png", full_page=True)
    opened.end("sweep")


def check_damaged(browser):
    opened = Opened(browser, "damaged.html")
    told = opened.warnings()
    unconverged = r"NOT CONVERGED: 1 increment of \d+: volume_loss 0.5 %"
    for sentence in (unconverged, "run.lock", r"cut \(halved\)", "cannot be read"):
        check(re.search(sentence, told), f"{sentence} is not at the top: {told}")
    opened.end("damaged run")


def check_scene(browser):
    """All stages on one slider; what is dug out cannot be clicked; the dot of the boundary follows the slider."""
    opened = Opened(browser, "scene.html")
    with h5py.File("scene/run.h5") as file:
        stages = [stage.decode() for stage in file["table/stage"][()]]
        reaction = file["table/reaction_door_y"][()]
    frames = opened.evaluate("report.views[0].ground.loads.length")
    check(frames == len(stages), f"{frames} states of {len(stages)}")
    inside = "report.views[0].pointAt(...report.views[0].toCanvas(1.1, {}))"
    for stage, whole in (("weight", True), ("free", False)):
        opened.slide(len(stages) - 1 - stages[::-1].index(stage))
        told = opened.page.locator("output.load").inner_text()
        check(told == f"{stage}, load parameter 1", told)
        check((opened.evaluate(inside.format(1.6)) is not None) == whole, f"{stage}: the region cut")
        check(opened.evaluate(inside.format(0.6)) is not None, f"{stage}: the region sand")
    last = len(stages) - 1 - stages[::-1].index("lower")
    opened.slide(last)
    drawn = opened.evaluate("report.charts[0].drawn.filter(s => s.name === 'lower')[0]")
    check(abs(drawn["y"][last] - reaction[last] / 1e3) < 1e-4 * abs(reaction[last]), f"{drawn['y'][last]}")
    check(opened.page.locator("[data-chart] circle.now").count() == 1, "no dot follows the slider")
    opened.page.screenshot(path="scene.png", full_page=True)
    opened.end("scene")


start = time.monotonic()
make_results()
fresh("scene")
Path("tiny_scene.toml").write_text(tiny_scene.CASE)
run([PROGRAM, "run", "tiny_scene.toml", "-o", "scene"])
made = time.monotonic()
said = [report("sweep/tunnels/cover_2", "ensemble.html", "--only", "ground_reaction")]
said.append(report("sweep", "sweep.html", "--only"))
report("damaged", "damaged.html", "--only", code=2)
report("scene", "scene.html", "--only", "boundary_curves")
fresh("begun").mkdir()
shutil.copy("damaged/run.h5", "begun")  # a tunnel whose column is still computed has no increment
report("begun", "begun.html", code=2)
check("no increments" in Path("begun.html").read_text(), "a run without increments is not told")
check("does not exist" in report("nowhere", "nowhere.html", code=2), "a missing folder is not told")
check(not Path("nowhere.html").exists(), "a page of nothing was written")
page = Path("ensemble.html").read_text()
check(page.count("data:image/webp") == 1 and "Figure 15b" in page, "the figure is not in the page with its number")
reported = time.monotonic()
with sync_playwright() as playwright:
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
    ready, slow = check_ensemble(browser, 1300)
    check_ensemble(browser, 400)
    check_sweep(browser)
    check_damaged(browser)
    check_scene(browser)
    browser.close()
print(
    f"runs {made - start:.1f} s, pages {reported - made:.1f} s, browser {time.monotonic() - reported:.1f} s; ensemble "
    f"{len(page.encode()) / 1e6:.2f} MB, ready after {ready:.0f} ms, slider {slow:.0f} ms (median); {said[0].strip()}"
)

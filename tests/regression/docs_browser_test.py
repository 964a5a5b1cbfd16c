"""The documents' site in a real browser, opened from files, without a network: pages of every kind are no wider than
their window, wide and narrow, tables, code and formulas included; pictures are there; the search finds a page and opens
it."""

import importlib.util
import shutil
import sys
import time
from pathlib import Path

from program import ROOT, check, run

CHROMIUM = shutil.which("chromium")
TOOL = ROOT / "tools/docs"
if (
    CHROMIUM is None
    or importlib.util.find_spec("playwright") is None
    or not (ROOT / ".prefix/docs/bin/python").exists()
):
    print("skipped: Chromium, Playwright or the documents' packages are missing; tools/setup --test installs them")
    sys.exit(77)
from playwright.sync_api import sync_playwright  # noqa: E402 - only where it is installed

WIDE, NARROW = 1400, 400
# Pictures are loaded only when they come into view, so that the page is asked for them at once.
LOAD_PICTURES = """async () => {
    const pictures = [...document.querySelectorAll("article img")];
    pictures.forEach(picture => { picture.loading = "eager"; });
    await Promise.allSettled(pictures.map(picture => picture.decode()));
    return pictures.filter(picture => picture.naturalWidth < 20).map(picture => picture.src);
}"""
# Blocks of an article that reach beyond it and that no frame of their own makes movable.
BEYOND = """() => {
    const edge = document.documentElement.clientWidth + 1;
    const moves = element => element && (["auto", "scroll", "hidden"].includes(getComputedStyle(element).overflowX)
        || moves(element.parentElement));
    return [...document.querySelectorAll("article *")]
        .filter(element => element.getBoundingClientRect().right > edge && !moves(element.parentElement))
        .map(element => element.outerHTML.slice(0, 80));
}"""
FORMULAS = """() => [...document.querySelectorAll("math")].filter(formula => {
    const box = formula.getBoundingClientRect();
    return box.width < 2 || box.height < 5;
}).length"""


class Opened:
    """A window of the browser; errors and requests to a network are collected."""

    def __init__(self, browser, width):
        self.width = width
        self.problems: list[str] = []
        self.page = browser.new_page(viewport={"width": width, "height": 900})
        self.page.on("console", lambda message: self.problems.append(f"console: {message.text}"))
        self.page.on("pageerror", lambda error: self.problems.append(f"error: {error}"))
        self.page.on("request", self._asked)

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:", "about:")):
            self.problems.append(f"request: {request.url}")

    def look(self, file):
        """Opens a page and checks how it is drawn."""
        self.page.goto(file.resolve().as_uri())
        what = f"{file} at {self.width} px"
        wide = self.page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        check(wide <= 0, f"{what}: the page is {wide} px wider than its window")
        beyond = self.page.evaluate(BEYOND)
        check(not beyond, f"{what}: reaches beyond the window: {beyond[:3]}")
        missing = self.page.evaluate(LOAD_PICTURES)
        check(not missing, f"{what}: pictures are missing: {missing}")
        check(self.page.evaluate(FORMULAS) == 0, f"{what}: a formula has no size")
        check(not self.problems, f"{what}: {self.problems}")


def kinds_of_pages(site):
    """The home page, those with most formulas, most cells, most pictures, most code, and the text of a file."""
    texts = {file: file.read_text() for file in site.rglob("*.html") if "source" not in file.parts}
    signs = ("<math", "<td", "<img ", '<div class="highlight">')
    chosen = [max(texts, key=lambda file: texts[file].count(sign)) for sign in signs]
    shown = min((site / "source").rglob("*.toml.html"))
    return list(dict.fromkeys([site / "index.html", *chosen, shown, site / "source/index.html"]))


def search(opened, site):
    """Types two words into the search; the first answer leads to a page that has them."""
    page = opened.page
    page.goto((site / "index.html").resolve().as_uri())
    if opened.width == NARROW:
        page.locator("label.md-header__button[for=__search]").click()
    page.locator("input.md-search__input").click()
    page.locator("input.md-search__input").press_sequentially("void ratio")
    answer = page.locator(".md-search-result__link").first
    answer.wait_for(timeout=20000)
    told = page.locator(".md-search-result__meta").inner_text()
    page.screenshot(path=f"search_{opened.width}.png")
    answer.click()
    page.wait_for_load_state()
    text = page.locator("article").inner_text().lower()
    check("void" in text and "ratio" in text, f"the first answer is {page.url}, which has not the words")
    check(not opened.problems, f"search: {opened.problems}")
    return told


def navigate(opened, site):
    """Comes from the home page to another page by the menu, as the width asks."""
    page = opened.page
    page.goto((site / "index.html").resolve().as_uri())
    if opened.width == NARROW:
        page.locator("label.md-header__button[for=__drawer]").click()
        page.wait_for_timeout(400)  # the drawer moves
        page.screenshot(path=f"menu_{NARROW}.png")
        page.locator(".md-sidebar--primary").get_by_role("link", name="Reference", exact=True).click()
    else:
        page.locator(".md-tabs").get_by_role("link", name="Reference", exact=True).click()
    page.wait_for_load_state()
    check(page.url.endswith("site/reference/index.html"), f"the menu leads to {page.url}")
    check(not opened.problems, f"menu: {opened.problems}")


start = time.monotonic()
run([str(TOOL), "-o", "site"])
built = time.monotonic()
site = Path("site")
chosen = kinds_of_pages(site)
with sync_playwright() as playwright:
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
    for width in (WIDE, NARROW):
        opened = Opened(browser, width)
        for number, file in enumerate(chosen):
            opened.look(file)
            opened.page.screenshot(path=f"page_{number}_{width}.png")
        told = search(opened, site)
        navigate(opened, site)
        opened.page.close()
    browser.close()
names = ", ".join(str(file.relative_to(site)) for file in chosen)
print(f"built in {built - start:.1f} s, looked at in {time.monotonic() - built:.1f} s: {names}; search: {told}")

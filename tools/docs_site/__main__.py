"""Builds the documents as a site of files that needs no server and no network, and checks all links and formulas."""

import argparse
import importlib.resources
import logging
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from mkdocs.commands.build import build
from mkdocs.config import load_config
from mkdocs.exceptions import MkDocsException

from docs_site.check_site import check_site
from docs_site.pages import Site

ROOT = Path(__file__).resolve().parent.parent.parent
CONFIGURATION = Path(__file__).resolve().parent / "mkdocs.yml"
NOT_FOR_FILES = ("404.html", "sitemap.xml", "sitemap.xml.gz")  # only a server shows them
MOST_TOLD = 200  # problems; a fault of the frame is on every page
FONT = "STIXTwoMath-Regular.ttf"


class Warnings(logging.Handler):
    """Collects what MkDocs and its theme warn of."""

    def __init__(self, problems: list[str]):
        super().__init__(logging.WARNING)
        self.problems = problems

    def emit(self, record: logging.LogRecord) -> None:
        self.problems.append(f"MkDocs: {record.getMessage()}")


def draw(site: Site, output: Path) -> None:
    """Lets MkDocs write all files of the site."""
    logger = logging.getLogger("mkdocs")
    logger.propagate = False
    handler = Warnings(site.problems)
    logger.addHandler(handler)
    try:
        config = load_config(str(CONFIGURATION), site_dir=str(output.resolve()))
        config.extra["site"] = site
        build(config)
    finally:
        logger.removeHandler(handler)
    for name in NOT_FOR_FILES:
        (output / name).unlink(missing_ok=True)
    # Browsers need a font with a table of mathematics for fractions, roots and large brackets.
    with importlib.resources.as_file(importlib.resources.files("ziamath.fonts") / FONT) as font:
        shutil.copy(font, output / FONT)


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/docs", description=__doc__)
    parser.add_argument(
        "-o", "--output", type=Path, default=ROOT / "build/docs", help="folder of the site (build/docs)"
    )
    parser.add_argument("--root", type=Path, default=ROOT, help="the checkout whose documents are drawn (this one)")
    given = parser.parse_args()
    start = time.monotonic()
    site, links = Site(given.root.resolve()), 0
    try:
        draw(site, given.output)
    except MkDocsException as error:
        site.problems.append(str(error))
    if not site.problems:  # a link that is wrong in the repository has been told already
        site.problems, links = check_site(given.output)
    for problem in site.problems[:MOST_TOLD]:
        print(f"docs: {problem}", file=sys.stderr)
    if site.problems:
        print(f"tools/docs: {len(site.problems)} problems", file=sys.stderr)
        return 1
    page = given.output / "index.html"
    print(f"docs: {len(site.pages)} pages and {links} links in {time.monotonic() - start:.1f} s: {page}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

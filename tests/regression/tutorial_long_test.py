"""docs/tutorial from the clone to the last number, every command as it is written. The clone is one of this checkout,
as it is committed, and takes over its .prefix, so that tools/setup finds its work done."""

import shutil
import sys

from program import ROOT, fresh
from tutorial_pages import Reader, follow
from tutorial_test import PAGES

SKIPPED = 77


def main():
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        print("skipped: this is no checkout of git")
        sys.exit(SKIPPED)
    folder = fresh("whole").absolute()
    folder.mkdir()
    reader = Reader(folder, whole=True)
    reader.environment["VOUSSOIR_NO_PACKAGES"] = "1"
    for page in PAGES:
        follow(ROOT / f"docs/tutorial/{page}.md", reader)


if __name__ == "__main__":
    main()

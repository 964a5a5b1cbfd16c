"""Every command of docs/tutorial runs, and says what its page promises; long commands are made smaller by the page's
marks (README.md, "The tutorial"). tutorial_long_test.py runs the pages as they are written."""

import time

from program import PROGRAM, ROOT, fresh
from tutorial_pages import Reader, follow

PAGES = ("first_tunnel", "one_rve", "own_soil", "own_problem")


def checkout(folder):
    """A folder that looks like a checkout with its program built, and holds nothing that a run has left."""
    folder.mkdir(parents=True)
    for name in ("cases", "tools", "docs", ".prefix"):
        (folder / name).symlink_to(ROOT / name)
    program = folder / "build/openmp/host/voussoir"
    program.parent.mkdir(parents=True)
    program.symlink_to(PROGRAM)
    return folder


def main():
    reader = Reader(checkout(fresh("voussoir").absolute()), whole=False)
    for page in PAGES:
        begin = time.monotonic()
        follow(ROOT / f"docs/tutorial/{page}.md", reader)
        print(f"  {time.monotonic() - begin:.1f} s")


if __name__ == "__main__":
    main()

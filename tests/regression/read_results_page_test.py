"""Every block of docs/how-to/read_results.md runs, with small runs in place of the page's."""

import os
import sys
from pathlib import Path

import matplotlib as mpl
from program import PROGRAM, ROOT, fresh
from tutorial_pages import Reader, follow

PAGE = ROOT / "docs/how-to/read_results.md"

mpl.use("agg")
folder = fresh("reader").absolute()
folder.mkdir()
for name in ("cases", "python", "docs"):
    (folder / name).symlink_to(ROOT / name)
sys.path.insert(0, str(ROOT / "python"))
reader = Reader(folder, whole=False)
reader.environment["PATH"] = f"{Path(PROGRAM).parent}:{os.environ['PATH']}"
follow(PAGE, reader)

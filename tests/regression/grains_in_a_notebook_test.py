"""The lesson docs/tutorial/grains_in_a_notebook.md runs and says what it promises, and its picture is drawn."""

import matplotlib as mpl
import python_package  # noqa: F401 - it ends the test as skipped where there is no compiled module
from program import ROOT, check, fresh
from tutorial_pages import Reader, follow

mpl.use("agg")
folder = fresh("lesson").absolute()
folder.mkdir()
follow(ROOT / "docs/tutorial/grains_in_a_notebook.md", Reader(folder, whole=False))
check((folder / "cyclic.png").stat().st_size > 20000, "the picture was not drawn")

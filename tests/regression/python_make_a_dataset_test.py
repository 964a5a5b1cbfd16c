"""docs/how-to/make_a_dataset.md does what it says, and the example that trains a network runs with a small set."""

import os
import sys
from pathlib import Path

import numpy as np
from program import ROOT, check, fresh, run
from python_package import voussoir  # noqa: F401  # ends here where the module was not built
from tutorial_pages import Reader, follow


def check_page(folder):
    reader = Reader(folder, whole=False)
    reader.environment["PATH"] = f"{Path(sys.executable).parent}:{reader.environment['PATH']}"  # python3 of this test
    follow(ROOT / "docs/how-to/make_a_dataset.md", reader)


def check_example(folder):
    """The errors stand in the order that they must have: on what it has learned, the network is no better than the mean
    of the packings, from which it learned; on what it has not seen, it is clearly better than the elastic law."""
    try:
        import sklearn  # noqa: F401, PLC0415
    except ImportError:
        print("scikit-learn is missing: the example did not run")
        return
    os.chdir(folder)
    size = ["--paths", "35", "--increments", "16", "--packings", "4", "--grains", "60"]
    said = run([sys.executable, str(ROOT / "python/examples/train_surrogate.py"), *size]).stdout
    errors = {
        line[:28].strip(): [float(word) for word in line[28:].split("|")]
        for line in said.splitlines()
        if "|" in line[60:] and "new" not in line
    }
    law, network, mean = (np.array(errors[name]) for name in ("elastic law", "network", "mean of training packings"))
    check(mean[2] < network[2] and network[0] < 0.8 * law[0], f"errors of the example:\n{said}")
    check(Path("surrogate.png").stat().st_size > 20000, "the figure")


def main():
    folder = fresh("make_a_dataset").absolute()
    folder.mkdir()
    check_page(folder)
    check_example(folder)


main()

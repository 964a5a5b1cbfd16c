#!/usr/bin/env python3
"""Draws the figures of a run of any kind, of packings, of an ensemble or of a sweep: tools/figures.py DIR [-o DIR]
[--only NAME ...]. This is the module voussoir.figures of the checkout; docs/reference/figures.md describes it."""

import runpy
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))
runpy.run_module("voussoir.figures", run_name="__main__")

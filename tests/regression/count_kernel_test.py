"""The compiled kernel of the GPU engine: no spilled numbers in the loop of steps, registers and fast memory for as many
blocks as planned, and as many instructions as were counted before. Skipped where there is no nvcc."""

import subprocess
import sys

from program import ROOT

raise SystemExit(
    subprocess.run([sys.executable, str(ROOT / "tools/count_kernel.py"), "--check"], check=False).returncode
)

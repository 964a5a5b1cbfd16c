"""A rank of the Micro Manager for precice_test.py: the answers of its points go to a file."""

import sys

import numpy as np
from precice_test import couple, macro_side, skip_where_something_is_missing
from python_package import voussoir

if __name__ == "__main__":
    skip_where_something_is_missing()
    from mpi4py import MPI
    from voussoir.precice import Hub

    voussoir.initialize(1)
    packings = [voussoir.load_packing(file) for file in sys.argv[1:]]
    hub = Hub(packings=packings)
    rank, size = MPI.COMM_WORLD.Get_rank(), MPI.COMM_WORLD.Get_size()
    written = couple(f"ranks_{size}_{rank}", macro_side(2, 2), hub, decomposition=[1, size])
    stress = np.stack([values for *_, name, values in written if name == "Stress-Y"])
    np.savez(f"rank_{rank}_of_{size}.npz", ids=hub.ids, stress=stress, evaluations=hub.evaluations)

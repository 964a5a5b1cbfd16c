"""Ranks on devices: each takes the device of its number on its machine, with the bits of one process on one device."""

import os
import signal
import subprocess

from devices import log_of, on_device, small_column
from launcher import end, on_ranks, skip_without_mpi, start, worker
from program import check, check_same, command, fresh, run

skip_without_mpi()
SETTINGS = small_column()


def words(folder, *further):
    return command("column", folder, SETTINGS, "--threads", "1", *further)


def ranks(n, folder, *further, devices=2):
    return on_device(on_ranks(n, words(folder, *further)), VOUSSOIR_EMULATED_GPUS=devices)


def device_lines(folder):
    return [line.split("rank ", 1)[1] for line in log_of(folder).splitlines() if ": grains " in line]


one = fresh("one")
run(on_device(words(one)))
check("grains on the device emulated device 0" in log_of(one), "one process does not say which device it has")

# Launchers have many names for a rank's number on its machine. MPI is asked and no variable, so that a wrong one is
# neither obeyed nor a fault.
named = fresh("named")
wrong = {"SLURM_LOCALID": "two", "MPI_LOCALRANKID": "-7", "OMPI_COMM_WORLD_LOCAL_RANK": "1"}
run(on_device(words(named), VOUSSOIR_EMULATED_GPUS=2, **wrong))
check("grains on the device emulated device 0" in log_of(named), "one process obeys a variable of some launcher")
check_same(one, named)

for n, devices in ((2, 2), (3, 2), (2, 1)):
    spread = fresh(f"ranks_{n}_devices_{devices}")
    run(["env", "SLURM_LOCALID=5", "MV2_COMM_WORLD_LOCAL_RANK=x", *ranks(n, spread, devices=devices)])
    check_same(one, spread)
    expected = [f"{rank}: grains on the device emulated device {rank % devices}" for rank in range(n)]
    check(device_lines(spread) == expected, f"{n} ranks, {devices} devices: the log says {device_lines(spread)}")

# A rank that is lost takes the others with it; two ranks, and one process, go on from the checkpoint.
for resume in (lambda folder: ranks(2, folder, "--resume"), lambda folder: on_device(words(folder, "--resume"))):
    lost = fresh("lost")
    process = start(ranks(2, lost), lost / "increments/0002.h5")
    os.kill(worker(process), signal.SIGKILL)
    end(process, 137)
    run(resume(lost))
    check_same(one, lost)

# A rank without a device: lanes serve its points, and the log says so; whoever insists on devices is refused.
shell = 'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then export VOUSSOIR_EMULATED_GPUS=0; fi; exec "$@"'


def unlike(folder, *further):
    return on_device(on_ranks(2, ["sh", "-c", shell, "sh", *words(folder, *further)]))


mixed = fresh("mixed")
run(unlike(mixed))
expected = ["0: grains on the device emulated device 0", "1: grains by lanes"]
check(device_lines(mixed) == expected, f"a rank without a device: the log says {device_lines(mixed)}")
asked = fresh("asked")
said = end(
    subprocess.Popen(
        unlike(asked, "--set", 'engine.backend="gpu"'), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ),
    4,
)
check(
    len(said) == 1 and "rank 1 on " in said[0] and "none can be used" in said[0],
    f"a rank lacks the device that is asked for: {said}",
)

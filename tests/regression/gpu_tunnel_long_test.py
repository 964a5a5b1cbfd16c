"""A tunnel of grains from gravity to a volume loss of 1 % on the device that is the host: the ground settles as with
lanes, within what draws of the packing move it by."""

import h5py
import numpy as np
from devices import last, log_of, on_device
from program import SMALL_TUNNEL, check, command, fresh, run, table

DRAWS = (1, 2, 3, 4)
SETTINGS = [
    *(setting for setting in SMALL_TUNNEL if not setting.startswith("volume_loss.total")),
    "volume_loss.total=1 %",
    "volume_loss.increments=4",
]


def words(folder, seed):
    return command("tunnel_quick", folder, [*SETTINGS, f"packing.seed={seed}"])


def settlement(folder):
    """Of the surface over the tunnel's crown [m]."""
    return table(folder)[-1]["surface_settlement"]


lanes = []
for seed in DRAWS:
    folder = fresh(f"lanes_{seed}")
    run(words(folder, seed))
    lanes.append(settlement(folder))
scatter = np.std(lanes, ddof=1)
device = fresh("device")
run(on_device(words(device, DRAWS[0])))
check("grains on the device emulated device 0" in log_of(device), "the device was not used")
with h5py.File(last(device)) as file:
    points = file["gauss/stress"].shape[0] * 4
check(points >= 100, f"there are {points} points only")
found = settlement(device)
print(
    f"{points} points of 100 grains: settlement {found:.4e} m on the device, {lanes[0]:.4e} m by lanes; draws "
    f"{np.mean(lanes):.4e} m with a scatter of {scatter:.1e} m"
)
check(
    abs(found - lanes[0]) < scatter,
    f"{found} m on the device instead of {lanes[0]} m: the scatter of draws is {scatter} m",
)
check(abs(found - np.mean(lanes)) < 3 * scatter, f"{found} m is not one of the draws {lanes}")

"""A small network in place of grains: how near does it come, and how near could it come?

    python3 train_surrogate.py [--paths 224] [--packings 8] [--grains 300] [--file set.h5] [--figure surrogate.png]

Makes a dataset (every path on every packing), trains a network of scikit-learn on training packings and training paths,
and judges it on new paths and new packings. Beside its errors stand those of an elastic law, and those of the best
guess of somebody who knows all about a path and nothing about the packing: the mean of the training packings.

The network gets what a material point of a finite-element program knows: its strain, the last increment, and memories
of the strains before that fade over several lengths. It returns the whole stress; errors are not fed back. Packings of
a recipe are isotropic on average: a path in turned axes gives the same stress, turned, and is learned as well."""

import argparse

import matplotlib
import numpy as np
import voussoir
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits
from voussoir import paths

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MEMORIES = (0.002, 0.006, 0.02)  # deviatoric strains over which a memory fades
FEATURES = 7 + 3 * len(MEMORIES)
UNIT = 100e3  # of stresses [Pa]


def make_dataset(given):
    """Random walks, straight legs with corners, and cycles. A second call reads what the first one made."""
    count, split = given.paths // 7, (0.75, 0.0, 0.25)
    kinds = {
        "random": paths.random(4 * count, given.increments, seed=1),
        "stratified": paths.stratified(2 * count, given.increments, seed=2),
        "cyclic": paths.cyclic(given.increments, np.geomspace(1e-3, 8e-3, count), 2, np.pi * np.arange(count) / count),
    }
    packings = voussoir.make_packings(given.packings, grains=given.grains, folder="packings")
    return paths.generate(
        given.file, kinds, packings, packing_of="all", packing_split=split, path_split=split, progress=True
    )


def parts_of(voigt, shear):
    """Tensors (..., 3) in Voigt order as (half the volume, half the difference, shear)."""
    return np.stack([voigt[..., :2].mean(-1), 0.5 * (voigt[..., 0] - voigt[..., 1]), shear * voigt[..., 2]], axis=-1)


def turned(parts, angle):
    """The same in turned axes: the two deviatoric parts turn by twice the angle."""
    mean, a, c = np.moveaxis(parts, -1, 0)
    cos, sin = np.cos(2 * angle), np.sin(2 * angle)
    return np.stack([mean, cos * a - sin * c, sin * a + cos * c], axis=-1)


def features(strain):
    """What a point knows at each point of time (paths, points, FEATURES), from its strains (paths, points, 3)."""
    change = np.diff(strain, axis=1, prepend=strain[:, :1])
    length = np.hypot(change[..., 1], change[..., 2])
    known = [strain, change, np.cumsum(length, axis=1)[..., None]]
    for reach in MEMORIES:
        memory = np.zeros_like(strain)
        for k in range(1, strain.shape[1]):
            memory[:, k] = np.exp(-length[:, k, None] / reach) * memory[:, k - 1] + change[:, k]
        known.append(memory)
    return np.concatenate(known, axis=-1)


def train(strain, stress, directions=6):
    """A network from features to stresses (paths, points, 3)."""
    angles = np.pi * np.arange(directions) / directions
    inputs = np.concatenate([features(turned(strain, angle)).reshape(-1, FEATURES) for angle in angles])
    outputs = np.concatenate([turned(stress, angle).reshape(-1, 3) for angle in angles])
    network = MLPRegressor(
        hidden_layer_sizes=(64, 64), early_stopping=True, max_iter=60, batch_size=256, random_state=0
    )
    with threadpool_limits(1):  # several threads are slower with matrices of this size
        return make_pipeline(StandardScaler(), network).fit(inputs, outputs / UNIT)


def predicted(network, strain):
    return UNIT * network.predict(features(strain).reshape(-1, FEATURES)).reshape(strain.shape)


def elastic(strain, stress, train):
    """The isotropic elastic law that fits the training paths best."""
    change = stress - stress[:, :1]
    parts = []
    for k in ([0], [1, 2]):
        e, s = strain[..., k], change[..., k]
        parts.append(e * (e[train] * s[train]).sum() / (e[train] ** 2).sum())
    return stress[:, :1] + np.concatenate(parts, axis=-1)


def error(guess, stress, axes=None):
    """Rms of the components xx, yy, xy of a difference over the mean p: all, or along some axes."""
    square = ((guess - stress) ** 2 * [2, 2, 1]).sum(-1) / 3
    return np.sqrt(square.mean(axes)) / -stress[..., 0].mean()


def draw(file, curves, errors, grains, network):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.6), layout="constrained")
    for part, (name, sign) in enumerate((("mean stress p", -1), ("(yy − xx)/2", -1), ("shear stress xy", 1))):
        colour = f"C{part}"
        one, guess, law, mean, scatter = (sign * curve[:, part] / 1e3 for curve in curves)
        left.fill_between(
            range(len(mean)),
            mean - scatter,
            mean + scatter,
            color=colour,
            alpha=0.2,
            label=None if part < 2 else "packings ± s.d.",
        )
        left.plot(one, colour, label=f"{name}, grains")
        left.plot(guess, colour, ls="--", label=None if part else "network")
        left.plot(law, colour, ls=":", lw=1.2, label=None if part else "elastic law")
        pair = (sign * stress[..., part].ravel() / 1e3 for stress in (grains, network))
        right.plot(*pair, ".", color=colour, ms=2, alpha=0.3, label=name)
    for (name, values), style in zip(errors.items(), (":", "--", "-", "-.")):
        middle.plot(100 * values, style, label=name)
    title = "A new path on a new packing"
    left.set(xlabel="increment", ylabel="stress [kPa]", ylim=(None, 1.45 * left.get_ylim()[1]), title=title)
    middle.set(xlabel="increment", ylabel="error over mean p [%]", ylim=(0, None), title="New paths, new packings")
    right.set(xlabel="stress of the grains [kPa]", ylabel="stress of the network [kPa]", title="All their points")
    right.axline((0, 0), slope=1, color="k", lw=0.8)
    left.legend(fontsize=8, ncols=2, loc="upper left")
    middle.legend(fontsize=8)
    right.legend(fontsize=8, markerscale=4)
    figure.savefig(file, dpi=100)


def main():
    parser = argparse.ArgumentParser(description="Trains a network on strain paths of grains.")
    numbers, names = {"paths": 224, "increments": 40, "packings": 8, "grains": 300}, {"file": "surrogate.h5"}
    for name, default in {**numbers, **names, "figure": "surrogate.png"}.items():
        parser.add_argument(f"--{name}", type=type(default), default=default)
    given = parser.parse_args()
    data = make_dataset(given)
    shape = (-1, len(data["packing/seed"]), data.points, 3)  # rows stand path by path
    strain = parts_of(data["strain"][:].astype(float), 0.5).reshape(shape)[:, 0]  # the same on all packings
    stress = parts_of(data["stress"][:].astype(float), 1.0).reshape(shape)
    usable = np.isfinite(stress).all((1, 2, 3))  # paths on which no packing failed
    new, old = (usable & (data["path/split"][:] == part) for part in (2, 0))
    unseen, seen = (np.flatnonzero(data["packing/split"][:] == part) for part in (2, 0))
    mean = stress[:, seen].mean(axis=1)  # a network that is not told the packing can learn nothing else
    guesses = {
        "elastic law": elastic(strain, mean, old),
        "network": predicted(train(strain[old], mean[old]), strain),
        "mean of training packings": mean,
    }
    print(f"{'error over mean p [%]':28} new paths, new packings | known, new | known, known")
    for name, guess in guesses.items():
        cases = ((new, unseen), (old, unseen), (old, seen))
        values = [100 * error(guess[path][:, None], stress[path][:, packing]) for path, packing in cases]
        print("{:28} {:23.1f} | {:10.1f} | {:12.1f}".format(name, *values))
    print(f"network against that mean, new paths: {100 * error(guesses['network'][new], mean[new]):.1f} %")
    grains = stress[new][:, unseen]
    errors = {name: error(guess[new][:, None], grains, (0, 1)) for name, guess in guesses.items()}
    scatter = stress[new].var(axis=1, ddof=1) @ np.array([2, 2, 1]) / 3
    errors["standard deviation between packings"] = np.sqrt(scatter.mean(axis=0)) / -grains[..., 0].mean()
    one, network = np.flatnonzero(new)[0], guesses["network"]
    curves = [stress[one, unseen[0]], network[one], guesses["elastic law"][one], mean[one]]
    spread = stress[one].std(axis=0, ddof=1) * np.array([-1, -1, 1])  # a size, in the signs of the figure
    draw(given.figure, [*curves, spread], errors, grains, np.broadcast_to(network[new][:, None], grains.shape))


main()

"""A stand-in for pyprecice: preCICE itself is not in Debian 12.

Where VOUSSOIR_MACRO is set, the Micro Manager runs alone and the macro side is a JSON file: `points` (how many),
`windows`, `iterations` of each time window, `steps` of each window, and `gradients`, a list of
[window][iteration][step] of the gradient [[xx, xy], [yx, yy]] of a point of weight 1; point p of n has the weight
1 + 0.3 p/n. What is written goes to `log`, in the order of writing.

Otherwise two participants of one process, each in a thread of its own, are coupled as `coupling-scheme:serial-implicit`
of the configuration says (couple.py).
"""

import json
import os
import queue
import re
from pathlib import Path
from typing import ClassVar

import numpy as np

log: list[tuple] = []


def Participant(name, configuration, rank, size):  # noqa: N802 - pyprecice's name
    if "VOUSSOIR_MACRO" in os.environ:
        return Alone(rank, size)
    return Coupled(name, configuration)


class Common:
    """What neither participant needs a coupling for."""

    begins, repeats, complete = True, False, False

    def get_mesh_dimensions(self, mesh):
        return 2

    def set_mesh_access_region(self, mesh, region):
        pass

    def is_time_window_complete(self):
        return self.complete

    def requires_reading_checkpoint(self):
        return self.repeats

    def finalize(self):
        pass

    def start_profiling_section(self, name):
        pass

    def stop_last_profiling_section(self):
        pass


class Alone(Common):
    def __init__(self, rank, size):
        self.macro = json.loads(Path(os.environ["VOUSSOIR_MACRO"]).read_text())
        n = self.macro["points"]
        self.ids = np.arange(n * rank // size, n * (rank + 1) // size)
        self.window = self.iteration = self.step = 0

    def initialize(self):
        pass

    def get_mesh_vertex_ids_and_coordinates(self, mesh):
        return list(self.ids), [np.array([0.5, (p + 0.5) / self.macro["points"]]) for p in self.ids]

    def get_max_time_step_size(self):
        return 1.0 / self.macro["steps"]

    def read_data(self, mesh, name, ids, dt):
        """Rows Gradient-X and Gradient-Y of the gradients."""
        window = min(self.window, self.macro["windows"] - 1)
        gradient = np.array(self.macro["gradients"][window][self.iteration][self.step])
        weights = 1 + 0.3 * np.asarray(ids)[:, None] / self.macro["points"]
        return weights * gradient["XY".index(name[-1])]

    def write_data(self, mesh, name, ids, values):
        log.append((self.window, self.iteration, self.step, name, np.array(values, float)))

    def is_coupling_ongoing(self):
        return self.window < self.macro["windows"]

    def requires_writing_checkpoint(self):
        return self.macro["iterations"] > 1 and self.begins

    def advance(self, dt):
        self.begins = self.repeats = self.complete = False
        self.step += 1
        if self.step < self.macro["steps"]:
            return
        self.step, self.iteration = 0, self.iteration + 1
        self.repeats = self.iteration < self.macro["iterations"]
        if not self.repeats:
            self.window, self.iteration = self.window + 1, 0
            self.begins = self.complete = True


class Coupled(Common):
    """A participant of serial-implicit. The first one provides the mesh; the second one decides about convergence."""

    queues: ClassVar[dict[str, queue.Queue]] = {}
    patience = 100  # seconds

    def __init__(self, name, configuration):
        text = Path(configuration).read_text()
        self.sides = re.findall(r'<participants first="(.*?)" second="(.*?)"', text)[0]
        self.first = name == self.sides[0]
        self.other = self.sides[self.first]
        self.mine = self.queues.setdefault(name, queue.Queue())
        self.windows = int(re.findall(r'<max-time-windows value="(\d+)"', text)[0])
        self.most = int(re.findall(r'<max-iterations value="(\d+)"', text)[0])
        measures = re.findall(r'<relative-convergence-measure limit="(.*?)" data="(.*?)"', text)
        self.limits = {data: float(limit) for limit, data in measures}
        self.window, self.iteration, self.written, self.before = 0, 0, {}, None

    def send(self, what):
        self.queues.setdefault(self.other, queue.Queue()).put(what)

    def set_mesh_vertices(self, mesh, positions):
        self.positions = np.array(positions)
        self.send(self.positions)
        return np.arange(len(positions))

    def initialize(self):
        if self.first:
            self.read = {}
        else:
            self.positions = self.mine.get(timeout=self.patience)
            self.read = self.mine.get(timeout=self.patience)

    def get_mesh_vertex_ids_and_coordinates(self, mesh):
        return list(range(len(self.positions))), list(self.positions)

    def get_max_time_step_size(self):
        return 1.0

    def read_data(self, mesh, name, ids, dt):
        return self.read[name][ids]

    def write_data(self, mesh, name, ids, values):
        self.written[name] = np.array(values, float)

    def is_coupling_ongoing(self):
        return self.window < self.windows

    def requires_writing_checkpoint(self):
        return self.begins

    def converged(self, before):
        if before is None:
            return self.iteration == self.most
        norm = np.linalg.norm
        small = [norm(self.read[n] - before[n]) <= limit * norm(self.read[n]) for n, limit in self.limits.items()]
        return all(small) or self.iteration == self.most

    def advance(self, dt):
        self.iteration += 1
        if self.first:
            self.send(dict(self.written))
            self.read, self.complete = self.mine.get(timeout=self.patience)
        else:
            self.complete = self.converged(self.before)
            self.send((dict(self.written), self.complete))
            self.before = None if self.complete else self.read
            if self.window + self.complete < self.windows:
                self.read = self.mine.get(timeout=self.patience)
        self.begins, self.repeats = self.complete, not self.complete
        if self.complete:
            self.window, self.iteration = self.window + 1, 0

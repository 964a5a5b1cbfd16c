"""A stand-in for pyprecice, with which the Micro Manager runs alone: the macro side is a file of numbers.

VOUSSOIR_MACRO names a JSON file: `points` (how many), `windows`, `iterations` of each time window, `steps` of each
window, and `gradients`, a list of [window][iteration][step] of the gradient [[xx, xy], [yx, yy]] of a point of weight
1; point p of n has the weight 1 + 0.3 p/n. What is written goes to `log`, in the order of writing.
"""

import json
import os
from pathlib import Path

import numpy as np

log: list[tuple] = []


class Participant:
    def __init__(self, name, configuration, rank, size):
        self.macro = json.loads(Path(os.environ["VOUSSOIR_MACRO"]).read_text())
        self.configuration = configuration
        n = self.macro["points"]
        self.ids = np.arange(n * rank // size, n * (rank + 1) // size)
        self.window = self.iteration = self.step = 0
        self.begins, self.repeats, self.complete = True, False, False

    def get_mesh_dimensions(self, mesh):
        return 2

    def set_mesh_access_region(self, mesh, region):
        pass

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

    def requires_reading_checkpoint(self):
        return self.repeats

    def is_time_window_complete(self):
        return self.complete

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

    def finalize(self):
        pass

    def start_profiling_section(self, name):
        pass

    def stop_last_profiling_section(self):
        pass

"""Fits of formulas in place of runs, for the tests of fits."""

import numpy as np

from ffimpact.fitting.emulator import Scales
from ffimpact.fitting.experiments import Experiment
from ffimpact.fitting.predictions import observed
from ffimpact.fitting.search import search

NONE = np.array([[0.0, np.inf]])  # nothing is known beforehand of an entry


class Formula:
    """Experiments whose answers are formulas: restitution exp(-l v^q), contact time (m/E)^0.4 v^-0.2,
    in place of runs. E and l are free."""

    def __init__(self, speeds, truth, chance, kinds=("restitution", "contact_time")):
        self.speeds, self.kinds, self.asked = speeds, kinds, 0
        self.stated = [np.zeros(len(kinds)) for _ in speeds]
        self.experiments = []
        for speed in speeds:
            exact = self.formula(speed, truth)
            errors = {"restitution": 0.003, "contact_time": 0.02 * exact["contact_time"]}
            self.experiments.append(Experiment(speed=speed, **{k: (exact[k] + errors[k] * chance.standard_normal(), errors[k]) for k in kinds}))

    @staticmethod
    def formula(speed, entries):
        return {"restitution": np.exp(-entries["l"] * speed**0.2), "contact_time": (1 / entries["E"]) ** 0.4 * speed**-0.2}

    def observed(self, i, predicted):
        return observed(self.experiments[i], predicted)

    def answers(self, points):
        self.asked += len(points)
        return [[np.array([self.formula(speed, point)[k] for k in self.kinds]) for point in points] for speed in self.speeds]


FREE = {"E": (1e6, 1e8), "l": (0.01, 0.3)}


def found_for(formula):
    scales = Scales(FREE)
    return scales, search(formula, scales, np.tile(NONE, (2, 1)), False)

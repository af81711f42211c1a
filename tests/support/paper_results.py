"""Artificial results of the paper's cases for tests of the verdicts: small, complete and in memory.
"""

from copy import deepcopy

import numpy as np
import pandas as pd

from examples.paper import judging as paper_judging, scripts
from examples.paper.friction_laws import VALUES

# An impact of eleven steps in contact and a flight after it. The force has two maxima; everything
# slides in the first two steps.
IMPACT = {"t": np.arange(14) * 4e-4, "dt": np.full(14, 4e-4), "normal_force": [0, 2, 5, 3, 6, 5, 6, 7, 6, 4, 2, 1, 0, 0],
          "sliding_fraction": [0, 1, 1, 0.1, 0.9, 0.1, 0.9, 0.1, 0.9, 0.1, 0.9, 0, 0, 0], "contact": np.zeros(14),
          "elastic": [0, 100, 300, 250, 400, 450, 500, 550, 400, 300, 200, 100, 100, 100], "vx": np.linspace(6, 2.6, 14), "spin": np.linspace(0, -130, 14)}
IMPACT["kinetic"] = np.array([900, 890, 880, 870, 860] + [850] * 9) - IMPACT["elastic"]
# The control with equal coefficients.
SMOOTH = IMPACT | {"sliding_fraction": [0, 1, 1, 0.8, 0.6, 0.4, 0.2, 0, 0, 0, 0, 0, 0, 0]}
END = {"contact_time": 4.51e-3, "thresholded_contact_time": 4.48e-3, "dofs": 304, "ellipticity_lost_time": 1e-4, "breakdown_time": None, "rebound_vx": 3.0, "rebound_vy": 8.7,
       "energy_drift": 2e-11, "cpu_seconds": 2.0, "steps": 100, "newton_iterations": 300, "factorizations": 20, "estimated_error": {"rebound": 0.002}}
KEPT = END | {"ellipticity_lost_time": None}
SPACE = KEPT | {"contact_time": 5e-3, "thresholded_contact_time": 4.8e-3, "impulse": 14.2, "rebound_vy": 7.8, "estimated_error": {"impulse": 2e-4, "rebound": 4e-4, "thresholded_contact_time": 4e-3}}
# Bodies of 10 kg/m that rebound under a force.
PUSH = {"t": np.arange(5) * 1e-3, "dt": np.full(5, 1e-3), "normal_force": np.array([0, 50e3, 80e3, 20e3, 0])}
PUSH["momentum_y"] = -80 + np.cumsum(PUSH["normal_force"] * 1e-3)
PUSH["vy"] = PUSH["momentum_y"] / 10
# A disc of 1000 kg/m on a block of 20000 kg/m: three steps in contact, one in flight.
BLOCK = {"t": [0, 0.01, 0.02, 0.03, 0.04], "normal_force": [0, 5, 5, 5, 0], "vy_1": [-10, -5, 1, 4, 4], "vy_2": [0, -0.25, -0.55, -0.7, -0.7],
         "kinetic_1": [50e3, 20e3, 5e3, 9e3, 8e3], "elastic_1": [0, 10e3, 5e3, 1e3, 2e3], "kinetic_2": [0, 10e3, 20e3, 25e3, 20e3],
         "elastic_2": [0, 9e3, 19e3, 15e3, 20e3], "kinetic": [50e3, 30e3, 25e3, 34e3, 28e3], "elastic": [0, 19e3, 24e3, 16e3, 22e3], "contact": [0, 1e3, 1e3, 0, 0]}
BLOCK_END = {"mass_1": 1000.0, "mass_2": 20000.0, "energy_initial": 50e3, "vibration_energy_1": 2e3, "vibration_energy_2": 35.1e3, "estimated_error": {"rebound": 0.002},
             "ellipticity_lost_time": None}
DISC = {"radius": 0.05, "young": 7e6, "density": 1722, "speed": 8.0}


# Friction and normal force [N] on 10 kg for steps of 20 and 5 us. The friction force jumps once or
# not at all, the normal force is smooth.
def slips(height, n):
    """The history of n steps in a contact of 1 ms and one step before it. The friction force falls
    by `height` in one step."""
    t = np.arange(n + 1) / n
    history = {"t": 1e-3 * t, "dt": np.full(n + 1, 1e-3 / n), "normal_force": 10 + 100 * t, "friction_force": 10 * t - height * (t > 0.5), "momentum_y": -80 + 0 * t, "vy": -8 + 0 * t}
    history["normal_force"][0] = 0
    return history


def waves(frequency):
    """The history of 200 steps in a contact of 4.4 ms. The force is half a sine with waves of a
    frequency [Hz]."""
    t = np.arange(201) * 2.2e-5
    force = np.maximum(np.sin(np.pi * t / 4.4e-3) * (1 + 0.3 * np.sin(2 * np.pi * frequency * t)), 0)
    return {"t": t, "dt": np.full(201, 2.2e-5), "normal_force": force}


JUMPS, SLIDES = ([slips(height, n) for n in (50, 200)] for height in (200.0, 0.0))
# Results of the disc on the block.
NEAR = {"rebound_vy_1": 5.0, "rebound_vy_2": -0.75, "impulse_y_1": 15e3, "mass_1": 1000.0, "contact_intervals": 1, "peak_force": 1e6, "warnings": [], "cpu_seconds": 2.0,
        "phase_seconds": {"search": 0.1}, "ellipticity_lost_time": None}
CHATTERS = NEAR | {"contact_intervals": 30, "peak_force": 2e6, "rebound_vy_1": 4.95}
LEAKS = CHATTERS | {"warnings": ["range: points slip through between each other"]}


class Memory(paper_judging.Results):
    """Results from dictionaries: summaries, histories and scenes by run; tables by sweep.

    Histories and summaries of the runs of a sweep, plain and refined, are stored by (sweep,
    selected values).
    """

    def __init__(self, folder, data):
        super().__init__(folder)
        # read: the folders that were read.
        self.given, self.read = data, set()

    def summary(self, name):
        self.read.add(self.run(name))
        return self.given["summary"][name]

    def history(self, name):
        self.read.add(self.run(name))
        return _arrays(self.given["history"][name])

    def scene(self, name):
        self.read.add(self.run(name))
        return self.given["scene"][name]

    def table(self, name):
        self.read |= set(self.folders(name))
        return self.given["table"][name].copy()

    def histories(self, name, **values):
        self.read |= set(self.pair(name, **values))
        return [_arrays(columns) for columns in self.given["histories"][name, *sorted(values.items())]]

    def summaries(self, name, **values):
        self.read |= set(self.pair(name, **values))
        return self.given["summaries"][name, *sorted(values.items())]

    def by_scripts(self, formulation, width):
        self.read |= {self.folder / "paper-scripts" / name for name in scripts.pair(formulation, width)}
        return self.given["summaries"][pairs(formulation, width)]

    def has(self, name):
        return name in self.given["summary"]

    def modes(self, name, **values):
        self.read |= set(self.pair(name, **values))
        return [self.given["modes"].to_records(index=False)] * 2

    def friction_laws(self):
        return self.given["laws"]

    def stick_slip(self):
        return self.given["stick-slip"]


def _arrays(history):
    return {name: np.array(values, dtype=float) for name, values in history.items()}


def key(name, **values):
    """The key of the histories and summaries of a sweep."""
    return (name, *sorted(values.items()))


def jump(law, static=0.7):
    return key("friction-jump", friction_static=static, law=law)


def steps(law, static=0.7):
    return key("friction-steps", friction_static=static, law=law)


def pairs(formulation, width="auto"):
    return key("paper-scripts", formulation=formulation, width=width)


def search(law="svk"):
    return key("closest-points", law=law)


def forces(law, speed):
    return key("law-comparison", law=law, speed=speed)


def speeds(times, error=1e-5, nu=(0.3, 0.45)) -> pd.DataFrame:
    """A sweep over the speed, 1 to 11 m/s."""
    n = len(times)
    table = pd.DataFrame({"speed": list(np.linspace(1, 11, n)) * len(nu), "nu": np.repeat(nu, n), "exit": 0, "contact_time": list(times) * len(nu),
                          "contact_time_error": error, "ellipticity_lost_time": np.nan, "contact_intervals": 1.0, "contact_intervals_error": 0.0})
    return table.assign(thresholded_contact_time=table.contact_time, thresholded_contact_time_error=error)


def laws() -> pd.DataFrame:
    """The friction laws as edp/friction-laws.edp tabulates them, at fewer velocities."""
    epsilon, parts = VALUES["slip_velocity"], []
    v = np.sort(np.append(np.linspace(-4, 4, 81), [1 - 1e-12, 1e-12 - 1])) * epsilon
    stick = np.abs(v) < epsilon * (1 - 1e-14)
    for panel, law, inside, outside in (("b", "sqrt", None, v / np.hypot(v, epsilon)), ("b", "tanh", None, np.tanh(v / epsilon)), ("b", "linear", v / epsilon, np.sign(v)),
                                        ("b", "linear-printed", v / (2 * epsilon), np.sign(v)), ("c", "linear", 0.7 * v / epsilon, 0.5 * np.sign(v))):
        ratio = outside if inside is None else np.where(stick, inside, outside)
        parts.append(pd.DataFrame({"panel": panel, "law": law, "side": np.where(stick, "stick", "slip"), "v": v, "ratio": ratio}))
    return pd.concat(parts, ignore_index=True)


def base() -> dict:
    """Results that give the verdict of the first case of each statement."""
    both = ("svk", "neohookean")
    rebound = {"rebound_vx": 3.0, "rebound_vx_error": 0.01, "rebound_vy": 8.7, "rebound_vy_error": 0.0, "contact_time": 4.1e-3, "contact_time_error": 3e-5, "exit": 0}
    data = {
        "laws": laws(),
        "stick-slip": pd.DataFrame({"angle": [60.0, 60.0, 60.0, 30.0], "law": ["svk", "svk", "neohookean", "svk"], "exit": 0, "order": [False, False, True, False],
                                    "quiet": [False, True, True, True], "ellipticity_lost_time": np.nan}),
        "modes": pd.DataFrame({"mode": [1, 2, 3], "frequency": [300.0, 790.0, 1200.0], "energy": [1.0, 1.0, 1e-3]}),
        "summary": {"disc-normal": KEPT | {"contact_time": 4.65e-3, "thresholded_contact_time": 4.62e-3}, "disc-normal-incompressible": KEPT | {"min_jacobian": 0.98, "volume_change": 5e-9, "thresholded_contact_time": 4.1e-3}, "disc-normal-neohookean": KEPT | {"min_jacobian": 0.88, "contact_time": 4.2e-3, "thresholded_contact_time": 4.18e-3},
                    "disc-oblique-svk": END, "disc-oblique": KEPT, "disc-rolling": KEPT | {"rebound_vx": 0.666}, "disc-block": BLOCK_END, "disc-block-neohookean": BLOCK_END,
                    "ball-axisymmetric-svk": END | {"contact_time": 6.03e-3, "thresholded_contact_time": 5.9e-3}, "ball-axisymmetric": SPACE, "ball": SPACE},
        "history": {name: PUSH for name in ("disc-normal", "disc-normal-neohookean", "ball-axisymmetric-svk")} | {"disc-block": BLOCK, "disc-block-neohookean": BLOCK},
        "scene": {"disc-normal": DISC, "ball": DISC, "disc-oblique-svk": DISC, "disc-rolling": DISC | {"speed": 1.0}},
        "histories": {jump(law, static): [IMPACT if static == 0.7 else SMOOTH] * 2 for law in both for static in (0.7, 0.5)}
                     | {forces(law, speed): [PUSH] * 2 for law in both for speed in (1, 10)}
                     | {steps(law, static): JUMPS if static == 0.7 else SLIDES for law in both for static in (0.7, 0.5)},
        "summaries": {jump("svk"): [KEPT] * 2, steps("svk"): [KEPT] * 2}
                     | {search(): [NEAR] * 2} | {pairs(pairing, width): [end] * 2 for width in ("auto", 0.049) for pairing, end in (("closest-point", NEAR), ("pairwise", NEAR), ("pairwise-printed", CHATTERS))}
                     | {forces(law, speed): [KEPT | {"newton_iterations": 450 if law == "neohookean" else 300}] * 2 for law in both for speed in (1, 10)},
        "table": {
            "friction-jump": pd.DataFrame([rebound | {"law": law, "friction_static": static} for law in both for static in (0.7, 0.5)]),
            "oblique": pd.DataFrame([rebound | {"nu": nu} for nu in (0.3, 0.45)]),
            "contact-time-svk": speeds([5e-3, 4.8e-3, 4.9e-3, 4.5e-3, 4.6e-3, 4e-3]),
            "contact-time-neohookean": speeds([5e-3, 4.8e-3, 4.7e-3, 4.5e-3]),
            "law-comparison": pd.DataFrame([{"speed": speed, "law": law, "exit": 0, "contact_time": 4e-3 + longer, "contact_time_error": 1e-5, "thresholded_contact_time": 4e-3,
                                             "peak_force": force, "peak_force_error": 10.0} for speed, law, longer, force in (
                                                 (1, "svk", 0, 8000.0), (1, "neohookean", 0, 8100.0), (10, "svk", 5e-4, 90e3), (10, "neohookean", 0, 100e3))]),
            "conservation": pd.DataFrame([{"integrator": scheme, "dt": dt, "exit": 0, "energy_drift": drift, "rebound_vy": 6.9, "ellipticity_lost_time": np.nan} for scheme, drifts in (
                ("bdf2", (0.1, 0.05, 0.02)), ("energy-momentum", (1e-11, 2e-11, 3e-11))) for dt, drift in zip((4e-5, 2e-5, 1e-5), drifts)]),
            "calibrate": pd.DataFrame([{"law": law, "nu": 0.3, "penalty": k, "exit": 0, "ellipticity_lost_time": np.nan, "contact_time": time, "contact_time_error": 1e-6,
                                        "thresholded_contact_time": time - 5e-5, "thresholded_contact_time_error": 1e-6, "max_penetration": 1e6 / k, "rebound_vy": 7.4 + 1e7 / k,
                                        "rebound_vy_error": 1e-3} for law in both for k, time in ((3e8, 5.2e-3), (1e9, 4.9e-3), (1e10, 4.8e-3), (1e12, 4.7e-3))]),
            "slip-limit": pd.DataFrame({"slip_velocity": [3.0, 1, 0.1, 0.01], "exit": 0, "rebound_vx": [3.3, 3.1, 3.04, 3.03], "rebound_vx_error": 0.02,
                                        "friction_work": [60.0, 50, 45, 44.5], "friction_work_error": 1.0}),
            # Stiffer contacts are shorter. On the finer mesh contacts are 0.1 ms longer. With k =
            # 1e9 all runs lose ellipticity.
            "calibrate-oblique": pd.DataFrame([{"angle": angle, "nu": nu, "penalty": k, "mesh_size": h, "exit": 0, "contact_time": time + 1e-4 * (h == 0.008) + 2e-4 * (angle == 30),
                                                "breakdown_time": np.nan, "ellipticity_lost_time": 1e-4 if k == 1e9 else np.nan}
                                               for angle in (60.0, 30.0) for nu in (0.3, 0.45) for k, time in ((3e8, 5e-3), (1e9, 4.7e-3), (1e10, 4.3e-3)) for h in (0.01, 0.008)]),
            # Softer contacts are longer. Ellipticity is lost with the stiff contact, and on the
            # finest mesh with all.
            "calibrate-ball": pd.DataFrame([{"nu": nu, "penalty": k, "mesh_size": h, "exit": 0, "contact_time": time + 100 * (0.3 - nu) * 1e-6, "breakdown_time": np.nan,
                                             "ellipticity_lost_time": 2e-3 if h == 0.01 or k == 1e9 else np.nan}
                                            for nu in (0.3, 0.45) for k, time in ((3e8, 6.1e-3), (5e8, 6.031e-3), (1e9, 5.8e-3)) for h in (0.0175, 0.015, 0.01)]),
        }}
    data["table"]["calibrate-ball-3d"] = data["table"]["calibrate-ball"].assign(energy_drift=1e-11).query("mesh_size > 0.01")
    return deepcopy(data)

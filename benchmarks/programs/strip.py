"""The common part of the programs that solve the scene strip-gravity (benchmarks/scenes/): flags,
grid and sag."""

import argparse

import numpy as np
import peer


def arguments(program: str) -> argparse.Namespace:
    """The flags, SI units, with lame_lambda and lame_mu [Pa]."""
    parser = argparse.ArgumentParser(description=f"strip-gravity with {program}; ends with a line of JSON")
    parser.add_argument("--law", default="neohookean")
    return peer.with_numbers(parser, {
        "width": (0.2, "m"), "height": (0.01, "m"), "young": (1e6, "Pa"), "nu": (0.0, "-"), "density": (1000.0, "kg/m3"),
        "gravity": (1e-3, "m/s2"), "end-time": (0.4, "s"), "dt": (4e-3, "s"), "mesh-size": (2.5e-3, "m"),
        "tolerance": (1e-10, "largest work of the residual in a step, over the energy of a free fall")})


def grid(options: argparse.Namespace) -> tuple[int, int]:
    """The numbers of elements along and across the strip."""
    return round(options.width / options.mesh_size), max(1, round(options.height / options.mesh_size))


def steps(options: argparse.Namespace) -> int:
    return round(options.end_time / options.dt)


def sag(heights: list[float]) -> float:
    """The largest way of the centre of mass down [mm], by a parabola through the lowest steps."""
    y = np.array([0.0, *heights])
    k = int(np.clip(y.argmin(), 1, len(y) - 2))
    a, b, c = np.polyfit([-1, 0, 1], y[k - 1 : k + 2], 2)
    return float(-1e3 * (c - b**2 / (4 * a)))

"""The conserving gap between deformable bodies (edp/program/contact/pair.idp), paper (9), for a
randomly deformed disc and block."""

from pathlib import Path

import numpy as np
import pytest

ROUND_OFF = 1e-13


def read(path: Path):
    """Reads the configuration that pair.edp wrote.

    Returns edges (body, 3 nodes, 2), points (body, position, penetration), degree and search
    distance.
    """
    lines = path.read_text().splitlines()
    edges, points, degree, reach = lines[0].split()
    table = np.array([line.split() for line in lines[1:1 + int(edges)]], float)
    nodes = table[:, 1:].reshape(-1, 2, 3).transpose(0, 2, 1)
    if degree == "1":
        nodes[:, 1] = (nodes[:, 0] + nodes[:, 2]) / 2
    where = np.array([line.split() for line in lines[1 + int(edges):]], float)
    assert len(where) == int(points)
    return table[:, 0].astype(int), nodes, where[:, 0].astype(int), where[:, 1:3], where[:, 3], float(reach)


def closest(x: np.ndarray, nodes: np.ndarray) -> float:
    """Distance of a point to parabolas (n, 3 nodes, 2), from the real roots of (y - x).y' in [0, 1]
    and both ends."""
    a, m, b = nodes.transpose(1, 0, 2)
    A, B, C = a - x, -3 * a + 4 * m - b, 2 * a - 4 * m + 2 * b
    best = np.inf
    for A, B, C in zip(A, B, C):
        roots = np.roots([2 * C @ C, 3 * B @ C, B @ B + 2 * A @ C, A @ B]) if C @ C > 1e-28 * (B @ B) else np.array([-(A @ B) / (B @ B)])
        r = np.clip(np.append(roots.real[abs(roots.imag) < 1e-9], [0, 1]), 0, 1)[:, None]
        best = min(best, np.linalg.norm(A + r * B + r * r * C, axis=1).min())
    return best


def winding(x: np.ndarray, nodes: np.ndarray) -> float:
    """Winding number of the outline of parabolas about a point: 1 inside, 0 outside."""
    r = np.linspace(0, 1, 201)[:, None, None]
    a, m, b = nodes.transpose(1, 0, 2)
    y = (1 - r) * (1 - 2 * r) * a + 4 * r * (1 - r) * m + r * (2 * r - 1) * b - x
    angle = np.unwrap(np.arctan2(y[..., 1], y[..., 0]), axis=0)
    return (angle[-1] - angle[0]).sum() / (2 * np.pi)


CASES = [(2, 0.02, 0.05, 0), (1, 0.02, 0.05, 0.7), (2, 0.1, 0.1, 2.5), (1, 0.1, 0.1, 0.4), (2, 0, 0, 0)]


@pytest.mark.few(3)
@pytest.mark.parametrize("degree, depth, noise, tilt", CASES)
def test_rows_conserve(measure, degree, depth, noise, tilt):
    """The rows satisfy B d = q1 - q0.

    This also holds if the step rotates the pair by a radian, which changes no gap, or moves it
    along the block by a third of an edge, forty times. No row of B has a resultant force or moment
    about the middle configuration, on edges, vertices and kinks. A step begins with the
    penetrations at the end of the last step.
    """
    numbers = measure("pair", degree=degree, depth=depth, noise=noise, tilt=tilt)
    assert numbers["randomInside"] > 10 or noise == 0
    assert numbers["cornerGap"] < ROUND_OFF  # a point exactly on a corner of the other body
    for name in ("random", "turn", "corner"):
        assert numbers[name + "Exact"] < ROUND_OFF and numbers[name + "Force"] < ROUND_OFF and numbers[name + "Moment"] < ROUND_OFF
        assert 0.1 < numbers[name + "Largest"] < 1.2
    assert max(numbers["turnChange"], numbers["slideExact"], numbers["slideJump"]) < ROUND_OFF
    assert numbers["turnSlots"] == numbers["randomSlots"]


@pytest.mark.few(2)
@pytest.mark.parametrize("degree, depth, noise, tilt", CASES)
def test_gaps_are_those_of_an_exhaustive_search(measure, tmp_path_factory, degree, depth, noise, tilt):
    """Gaps agree with the distances to all edges of the other body, by the roots of a cubic; the
    winding number decides what is inside."""
    path = tmp_path_factory.mktemp("pair") / "configuration"
    measure("pair", degree=degree, depth=depth, noise=noise, tilt=tilt, place=path)
    edge_body, nodes, body, x, q, reach = read(path)
    near = 0
    for b in (0, 1):
        other = nodes[edge_body != b]
        for p in np.flatnonzero(body == b):
            distance = closest(x[p], other)
            signed = distance if winding(x[p], other) > 0.5 else -distance
            if q[p] > -1e29 and signed > -reach / 2:
                near += 1
                assert q[p] == pytest.approx(signed, abs=1e-14)
            else:
                assert signed < -reach / 2
    assert near > 10

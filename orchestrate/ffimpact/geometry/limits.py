"""The accepted lengths, in SI units."""

__all__ = ["LONGEST", "SHORTEST"]

LONGEST = 1e9  # largest accepted length [m] and velocity [m/s]
SHORTEST = 1e-9  # smallest accepted length [m]

"""Shared by the tests of solid."""



RADIUS = 0.05

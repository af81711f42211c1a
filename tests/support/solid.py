"""Helpers that the modules test_solid.py share."""



RADIUS = 0.05

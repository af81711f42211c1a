"""Curves, surfaces and motions that are given by formulas and need no mesh."""

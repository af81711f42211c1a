"""Curves and motions as formulas, without a mesh."""

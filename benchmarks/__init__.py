"""Measurements of ffimpact itself, started with `python -m benchmarks NAME` in the source folder.

They measure its cost, the convergence of its errors, the coverage of its error estimates and its
robustness in difficult scenes. `peers` runs other programs on the same problems.
"""

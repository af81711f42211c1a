"""Sweeps: runs of one scene over ranges of parameters, and their figures. The built-in sweeps are
the *.toml files in this folder.
"""

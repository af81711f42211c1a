"""Scenes of bodies: reads their tables, prepares them for the scripts, and holds the built-in
scenes.
"""

"""Scenes of bodies, as tables say them and as the scripts read them; the built-in ones beside."""

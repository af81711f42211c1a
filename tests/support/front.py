"""Helpers that the modules test_front.py share."""

from ffimpact import scene

BLOCK = """
accuracy = 0.02
law = "neohookean"
young = 1e6
nu = 0.0
density = 1e3
[[body]]
shape = "rectangle"
width = 0.2
height = 0.1
position = [0, 0.05]
velocity = [0, -0.3]
[[obstacle]]
kind = "plane"
point = [0, 0]
normal = [0, 1]
"""


def scene_of(text: str, tmp_path, **entries) -> scene.Scene:
    """The scene of a text with some entries set. In names two underscores stand for a dot."""
    path = tmp_path / "scene.toml"
    path.write_text(text)
    return scene.load(str(path)).override({name.replace("__", "."): value for name, value in entries.items()})

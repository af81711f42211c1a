"""
A mesh of your own: a button
============================

Any body that gmsh can mesh can be thrown. Here a button with four holes is meshed in Python,
written to a file and thrown on the floor, where it shears, springs back and picks up spin.
"""

from pathlib import Path

import gmsh
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The mesh
# --------
# The mesh in millimetres. Boundary elements in the physical group ``contact`` may touch; without
# groups, as here, all of them may.
radius, hole, offset, size = 20.0, 4.0, 8.0, 2.0
if gmsh.isInitialized():
    gmsh.finalize()  # ends a gmsh session of another page
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.add("button")
disc = gmsh.model.occ.addDisk(0, 0, 0, radius, radius)
angles = np.radians([45, 135, 225, 315])
holes = [
    (2, gmsh.model.occ.addDisk(offset * np.cos(angle), offset * np.sin(angle), 0, hole, hole))
    for angle in angles
]
gmsh.model.occ.cut([(2, disc)], holes)
gmsh.model.occ.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMax", size)
gmsh.model.mesh.generate(2)
folder = Path("results")
folder.mkdir(exist_ok=True)
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
gmsh.write(str(folder / "button.msh"))
gmsh.finalize()

# %%
# The scene
# ---------
# The body is the file, with the length of its unit.
rubber = ff.NeoHookean(young=5e6, nu=0.4, density=1200)
button = ff.Mesh(
    file=str(folder / "button.msh"),
    scale=1e-3,
    material=rubber,
    position=(0, 0.0205),
    velocity=(3, -5),
)
friction = 0.25
contact = ff.Contact(friction_static=friction)
scene = ff.Scene(
    title="button", bodies=[button], obstacles=[ff.Plane()], contact=contact, accuracy=0.02
)
result = ff.run(scene)
result

# %%
# Shapes
# ------
# The button before, at the largest force and after.
fig, axes = plt.subplots(1, 3, figsize=(9, 3), layout="constrained")
peak = float(result.history.t[result.history.normal_force.idxmax()])
for ax, time in zip(axes, (0.0, peak, float(result.history.t.iloc[-1]))):
    result.plot.shapes(ax=ax, time=time)
plt.show()

# %%
# Forces
# ------
# Normal force and friction. Friction changes its sign, as the sheared button springs back along the
# floor.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.force(ax=ax)
plt.show()

# %%
# Comparison
# ----------
# The mass is that of the exact outline, up to the arcs that the mesh cuts off: a chord of length
# s of a circle of radius r leaves out about :math:`s^2/(6 r^2)` of the area. Momentum is exact.
mm2, history = 1e-6, result.history
area = np.pi * (radius**2 - 4 * hole**2) * mm2
cut = np.pi * (size**2 / 6 + 4 * size**2 / 6) * mm2
mass, energy = result["mass"], history.kinetic + history.elastic + history.contact
change, bar = mass * (5 + result["rebound_vy"]), mass * result.errors["rebound_vy"]
lost = (energy + history.friction_work).iloc[-1]
rows = [
    ("mass", "kg/m", mass, 1200 * cut, 1200 * area, 0, "exact outline", ""),
    ("impulse", "N s/m", result["impulse"], result.errors["impulse"] + bar, change, 0,
     "exact: change of momentum", ""),
    ("impulse of friction", "N s/m", np.sum(history.friction_force * history.dt), bar,
     mass * (result["rebound_vx"] - 3), 0, "exact: change of momentum", ""),
    ("energy kept and taken by friction", "J/m", lost, 1e-8 * energy.iloc[0], energy.iloc[0], 0,
     "exact: balance of energy", ""),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A ``.step`` or ``.geo`` file in place of the mesh, which the program meshes itself.
# * Less friction: from where on does the button slide throughout?

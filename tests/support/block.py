"""The Python interface from a scene to a sweep, as a user types it in the cells of a notebook;
coarse, hence fast."""

SCENE = """
import ffimpact as ff
rubber = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
scene = ff.Scene(bodies=[ff.Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))],
                 obstacles=[ff.Plane()], contact=ff.Contact(friction_static=0.3), accuracy=0.1)
result = ff.run(scene, accuracy=0.1, fields=6)
"""
RESULT = "result"
NUMBERS = 'result["impulse"], result.errors["impulse"], result.units["impulse"]'
HISTORY = 'result.history.plot("t", "normal_force")'
TABLES = "result.contacts, result.warnings, result.scene"
PLOTS = "ax = result.plot.force(); result.plot.energies(); result.plot.shapes()"
STATE = """
last = result.fields[-1]
print(last.von_mises.max(), last.positions.min(axis=0), result.probe(0, -0.05).y.min())
"""
PLAYER = 'print(result.view("impact.html"))'
SWEEP = """
study = ff.sweep(scene, {"body.1.velocity.2": [-2, -8], "contact.friction_static": [0.1, 0.3]}, workers=2)
study.table
"""
STUDY = 'study.plot(x="body.1.velocity.2", y="restitution", by="contact.friction_static")'
COMPARE = """
ff.run(scene.set(**{"body.1.velocity.2": -4}), out="results/slow")
ff.compare(result, ff.load("results/slow"))
"""
SAVE = 'scene.save("drop.toml"); assert ff.Scene.load("drop.toml") == scene'
CELLS = [SCENE, RESULT, NUMBERS, HISTORY, TABLES, PLOTS, STATE, PLAYER, SWEEP, STUDY, COMPARE, SAVE]

"""Forces of three cases by the paper's scripts and by the program: an oblique disc and a ball of
revolution on the same mesh, and the disc on the block."""

import sys

from style import BLUE, FOLDER, ORANGE, WIDTH, plt, save

sys.path.insert(0, str(FOLDER.parents[1]))
import ffimpact as ff
from examples.paper import scripts

RUNS = FOLDER / ".runs"
OBLIQUE = {"speed": 12, "angle": 60, "friction_static": 0.7, "friction_dynamic": 0.5}
CASES = (("disc-oblique", "disc-plane", OBLIQUE | {"law": "neohookean", "dt": 4e-5}),
         ("ball-axisymmetric", "ball-axisymmetric", {"law": "neohookean", "dt": 1e-4}),
         ("disc-block", "disc-block", {"mesh_size": 0.3, "contact_mesh_size": 0.1, "dt": 8e-4}))
figure, panels = plt.subplots(1, 3, figsize=(WIDTH, 2.6), layout="constrained")
for ax, (scene, script, flags) in zip(panels, CASES):
    sizes = {} if scene == "disc-block" else {"mesh_size": 0.02, "contact_mesh_size": 0.01}
    run = ff.run(scene, estimate=False, penalty=1e9, out=RUNS / f"beside-{scene}", progress=False, **sizes)
    mesh = {"mesh": scripts.on_the_plane(run.folder / "mesh.msh")} if sizes else {}
    scripts.compute(RUNS / f"script-{scene}", script, flags | mesh | {"penalty": 1e9})
    for result, color, line, label in ((run, BLUE, "-", "program"), (ff.load(RUNS / f"script-{scene}"), ORANGE, "--", "script")):
        h = result.history
        ax.plot(1e3 * (h.t - h.dt / 2), 1e-3 * h.normal_force, line, color=color, label=label, lw=1.4)
        if h.friction_force.any():
            ax.plot(1e3 * (h.t - h.dt / 2), 1e-3 * h.friction_force, line, color=color, lw=0.9)
    per = "" if scene == "ball-axisymmetric" else "/m"
    ax.set(title=scene, xlabel="time [ms]", ylabel=f"force [kN{per}]", xlim=(0, 1.1e3 * run["contact_time"]))
    print(scene, {name: (run[name], result[name]) for name in ("contact_time", "impulse") + (("rebound_vy",) if "rebound_vy" in run else ())})
panels[0].legend(fontsize=8)
save(figure, "paper-scripts")

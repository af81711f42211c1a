"""A rigid block thrown up a slope that holds it, with and without damping of the penalty."""

import math

from style import BLUE, FOLDER, GREY, RED, WIDTH, plt, save

import ffimpact as ff

alpha, height = math.radians(25), 0.02
up, normal = (math.cos(alpha), math.sin(alpha)), (-math.sin(alpha), math.cos(alpha))
figure, ax = plt.subplots(figsize=(WIDTH, 2.8), layout="constrained")
for damping, colour, label in ((0.0, RED, "penalty_damping = 0"), (1e-3, BLUE, "penalty_damping = 1e-3 s")):
    block = ff.Rectangle(width=0.1, height=height, angle=25, rigid=True, density=1000, position=[n * height / 2 for n in normal], velocity=list(up),
                         mesh_size=0.01, contact_mesh_size=0.01)
    contact = ff.Contact(penalty=1e8, friction_static=0.6, friction_dynamic=0.3, slip_velocity=2e-3, penalty_damping=damping)
    scene = ff.Scene(bodies=[block], obstacles=[ff.Plane(point=[0, 0], normal=list(normal))], contact=contact, gravity=9.81, end_time=0.4, accuracy=0.02)
    history = ff.run(scene, estimate=False, out=FOLDER / f".runs/rest-{damping:g}", progress=False).history
    distance = (history.x - history.x.iloc[0]) * up[0] + (history.y - history.y.iloc[0]) * up[1]
    ax.plot(1e3 * history.t, 1e3 * distance, color=colour, label=label)
exact = 1 / (2 * 9.81 * (math.sin(alpha) + 0.3 * math.cos(alpha)))
ax.axhline(1e3 * exact, color=GREY, ls=":", label=r"$v^2/[2g\,(\sin\alpha+\mu_d\cos\alpha)]$")
ax.set(xlabel="time [ms]", ylabel="distance up the slope [mm]")
ax.legend(loc="lower center")
save(figure, "rest")

# The front door. Parameters live in orchestrate/ffimpact/input/, scenes in orchestrate/ffimpact/scenes/*.toml.
# ARGS is handed on:  make disc-normal ARGS="--set speed=4 --out results/slow"
PYTHON := .venv/bin/python
READY := .venv/.ready
# Without stored bytecode each of a thousand processes would compile the package again.
unexport PYTHONDONTWRITEBYTECODE
SWEEPS := oblique friction-jump friction-steps slip-limit contact-time-svk law-comparison contact-time-neohookean closest-points calibrate calibrate-oblique calibrate-ball calibrate-ball-3d conservation

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help setup disc-normal disc-oblique disc-rolling ball-axisymmetric ball ball-oblique ball-comparison disc-block friction-laws $(SWEEPS) stick-slip verify paper-scripts paper movie docs pictures check unit quick coverage mutants test robustness bench bench-quick scaling equal-errors promise disc-block-errors oblique-angles viscoelastic rubber layers users clean

help: ## list the targets
	@sed -n 's/^\([a-z0-9-]*\):.*## /  make \1\t/p' Makefile | expand -t 32

setup: $(READY) ## install what is missing: FreeFem++, system libraries, .venv with the packages of requirements.lock
$(READY): requirements.lock orchestrate/setup.sh edp/program/version.edp
	@orchestrate/setup.sh
	@touch $@

disc-normal: $(READY) ## a disc falls normally on a rigid plane (paper, sections 3.1 and 3.3)
	@$(PYTHON) -m ffimpact run $@ $(ARGS)

disc-oblique: $(READY) ## a disc hits the plane at 60 degrees, with friction: as the paper may have run it, and converged (section 3.1)
	@$(PYTHON) -m ffimpact compare disc-oblique-svk disc-oblique $(ARGS)

disc-rolling: $(READY) ## a disc is set down on the plane, slides and comes to roll (section 3.1)
	@$(PYTHON) -m ffimpact run $@ $(ARGS)

ball-axisymmetric: $(READY) ## a ball falls normally on a rigid plane, as a body of revolution: as the paper may have run it, and converged (section 3.3)
	@$(PYTHON) -m ffimpact compare ball-axisymmetric-svk ball-axisymmetric $(ARGS)

ball: $(READY) ## the same ball in three dimensions, a quarter of it by symmetry (section 3.3)
	@$(PYTHON) -m ffimpact run $@ $(ARGS)

ball-oblique: $(READY) ## a ball hits the plane at 60 degrees, with friction, in three dimensions
	@$(PYTHON) -m ffimpact run $@ $(ARGS)

ball-comparison: $(READY) ## accelerations of the centre of mass: disc with both laws, ball with both laws (figure 11); again with the same penalty
	@$(PYTHON) -m ffimpact run disc-normal-incompressible $(ARGS)
	@$(PYTHON) -m ffimpact compare disc-normal disc-normal-neohookean ball-axisymmetric-svk ball-axisymmetric $(ARGS)
	@$(PYTHON) -m ffimpact compare disc-normal disc-normal-neohookean ball-axisymmetric-svk ball-axisymmetric --set penalty=1e10 --out results/same-penalty $(ARGS)

disc-block: $(READY) ## a disc falls on a free block of the same material: with the paper's law, and neo-Hookean (section 3.2)
	@$(PYTHON) -m ffimpact compare disc-block disc-block-neohookean $(ARGS)

friction-laws: $(READY) ## draw the friction laws (figure 3)
	@$(PYTHON) -m examples.paper.friction_laws $(ARGS)

$(SWEEPS): $(READY)
	@$(PYTHON) -m ffimpact sweep $@ $(ARGS)
oblique: ## the oblique impact over nu, with error bars (section 3.1)
friction-jump: ## the oblique impact with both laws, and with equal friction coefficients as its control (figures 5, 6a)
friction-steps: ## the friction force with two steps: whether the acceleration jumps (figure 5b)
slip-limit: ## the oblique impact as epsilon goes to 0 (equation 12)
contact-time-svk: ## sweep the speed with St. Venant-Kirchhoff (figure 6b)
law-comparison: ## the force histories of both laws at 1 and 10 m/s (figure 7)
contact-time-neohookean: ## sweep the speed with the neo-Hookean law (figure 8)
closest-points: ## what the search for closest points (9) costs
calibrate: ## for which nu and k the paper's 0.0048 s at 8 m/s is met
calibrate-oblique: ## for which nu, k and coarse mesh the paper's 0.0045 s of the oblique disc is met
calibrate-ball: ## for which nu, k and coarse mesh the paper's 0.00603 s of the ball is met
calibrate-ball-3d: ## the same in three dimensions
conservation: ## the energy's drift over the step, with BDF2 and energy-momentum

stick-slip: $(READY) ## search for the paper's order of sliding and sticking over epsilon, k and nu
	@$(PYTHON) -m examples.paper.stick_slip $(ARGS)

verify: $(READY) ## exact solutions with convergence: bar, rod, Hertz, rigid bodies, friction, manufactured motions
	@$(PYTHON) -m verification $(ARGS)

paper-scripts: $(READY) ## the paper as FreeFEM scripts alone (edp/*.edp), without the program
	@$(PYTHON) -m examples.paper.scripts $(ARGS)

PAPER := disc-normal disc-oblique disc-rolling disc-block ball-axisymmetric ball friction-laws $(SWEEPS) stick-slip verify ball-comparison paper-scripts
paper: $(READY) ## all of the above, and results/paper/report.html
	@$(PYTHON) -m examples.paper --make $(PAPER)

movie: CASE := disc-oblique
movie: $(READY) ## a film of a scene, built in or a file: make movie CASE=disc-oblique
	@$(PYTHON) -m ffimpact $@ "$(CASE)" $(ARGS)

docs: .venv/.docs ## the documentation as a site, with the gallery of examples: results/site/html (ARGS="-D plot_gallery=0": without running them)
	@$(PYTHON) docs/pages.py >/dev/null
	@$(PYTHON) -m sphinx -q -W --keep-going -d results/site/doctrees docs results/site/html $(ARGS) && echo "results/site/html/index.html"

.venv/.docs: $(READY) pyproject.toml
	@$(PYTHON) -m pip install -q --disable-pip-version-check -e ".[docs]"
	@touch $@

pictures: $(READY) ## the animation of README.md and docs/index.md, made again
	@$(PYTHON) -m ffimpact movie disc-oblique --frames 40 --format gif
	@$(PYTHON) docs/pictures.py

check: $(READY) unit ## style, types, spelling and the tests without FreeFEM, in under a minute
	@$(PYTHON) -m ruff check -q orchestrate examples benchmarks verification tests docs conftest.py
	@$(PYTHON) -m ruff format -q --check orchestrate tests/unit/test_api.py tests/run/test_api.py tests/support/api.py conftest.py
	@$(PYTHON) -m mypy orchestrate/ffimpact
	@$(PYTHON) -m codespell_lib

unit: $(READY) ## the tests that need no FreeFEM, some twenty seconds
	@$(PYTHON) -m pytest -q -n 2 --dist worksteal tests/unit $(ARGS)

QUICK := $(addsuffix .py,$(addprefix tests/run/test_,end_to_end contacts bodies supports gases reported_numbers scenes rigid) $(addprefix verification/test_,patch conservation))
quick: $(READY) ## these and runs of each kind of scene, some two minutes
	@$(PYTHON) -m pytest -q -n 2 --dist worksteal tests/unit $(QUICK) $(ARGS)

coverage: $(READY) ## the lines of the package that the tests without FreeFEM run
	@$(PYTHON) -m pytest -q -n 2 --dist worksteal --cov=ffimpact --cov-report=term:skip-covered tests/unit $(ARGS)

mutants: $(READY) ## thirty alterations of the package, one at a time: how many the tests without FreeFEM notice; about half an hour
	@$(PYTHON) tests/mutants.py $(ARGS)

test: $(READY) ## run all tests, on two cores: some seven minutes
	@$(PYTHON) -m pytest -q -n 2 --dist worksteal $(if $(filter check unit,$(MAKECMDGOALS)),--ignore=tests/unit) $(ARGS)

robustness: $(READY) ## the tests that make test leaves out, malformed input and kills; hard runs drawn at random, and every combination of hard parameters: nothing is silently wrong, lost or left behind
	@$(PYTHON) -m pytest -q -n 2 --dist worksteal -m robustness
	@$(PYTHON) -m benchmarks promise --hard --scenes 200 --seed 201 --out results/robustness --page docs/measurements/robustness.md $(ARGS)
	@$(PYTHON) -m benchmarks promise --hard --of disc-block --scenes 20 --seed 202 --out results/robustness-block --page docs/measurements/robustness-block.md $(ARGS)
	@$(PYTHON) -m benchmarks promise --hard --of ball-axisymmetric --scenes 20 --seed 203 --out results/robustness-ball --page docs/measurements/robustness-ball.md $(ARGS)
	@$(PYTHON) -m benchmarks stress

disc-block-errors: override ARGS += --page docs/measurements/disc-block.md
rubber layers: override ARGS += --page docs/measurements/$@.md
equal-errors: override ARGS += --page docs/measurements/bench.md
promise scaling users: override ARGS += --page docs/measurements/$@.md
bench scaling equal-errors promise disc-block-errors rubber layers users: $(READY)
	@$(PYTHON) -m benchmarks $@ $(ARGS)
bench: ## run time against error: meshes, steps, integrators, and other programs where installed
bench-quick: $(READY) ## the same for one case, coarse
	@$(PYTHON) -m benchmarks bench --quick $(ARGS)
scaling: ## what a step costs over the number of unknowns, by phase, and memory: exponents (docs/measurements/scaling.md)
equal-errors: ## who takes how long for 1, 0.5 and 0.1 %, other programs where installed (docs/measurements/bench.md)
promise: ## whether accuracy means what it says, and stated errors hold, over 240 scenes drawn at random
disc-block-errors: ## the disc on the free block (section 3.2) over law, nu, stiffness and mesh, with error bars; NGSolve beside it
oblique-angles: $(READY) ## disc and ball over the angle of incidence, beside rigid and elastic theory (ARGS="--friction 0.2 --angles 20,40,60")
	@$(PYTHON) -m benchmarks $@ $(or $(ARGS),--page docs/measurements/$@.md)
viscoelastic: $(READY) ## damped impacts: a slow ball against quasi-static theory, a disc over loss factor and relaxation time
	@$(PYTHON) -m benchmarks $@ $(or $(ARGS),--page docs/measurements/$@.md)
rubber: ## disc and ball as nu -> 0.5: answers and cost, with the mean volume of elements and at points, NGSolve where installed
layers: ## a layered ball beside NGSolve on the same mesh

users: ## scenes of users: time and error with automatic steps and by hand, and over a stiffness ratio (docs/measurements/users.md)

clean: ## remove all results (keeps .venv)
	@find results -mindepth 1 ! -name README.md -delete

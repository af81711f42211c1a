"""The player of a run: one page that needs no network, tested in a headless browser."""

import io
import re
import shutil
import time

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.__main__ import main
from ffimpact.output import vtu
from ffimpact.view import states_of
from tests.support.api import RUBBER, drop

BALL = {"radius": 0.05, "material": RUBBER}
SCENES = {
    "plane": drop(),
    "axisymmetric": ff.Scene(
        bodies=[ff.Ball(**BALL, position=0.051, velocity=-8)], obstacles=[ff.Plane()]
    ),
    "space": ff.Scene(
        bodies=[ff.Ball(**BALL, position=(0, 0.051, 0), velocity=(0, -8, 0))],
        obstacles=[ff.Plane(normal=(0, 1, 0), point=(0, 0, 0))],
    ),
}
ARGUMENTS = (
    "headless no-sandbox disable-quic no-first-run disable-background-networking "
    "disable-component-update disable-sync enable-unsafe-swiftshader window-size=1000,560"
)


@pytest.fixture(scope="module", params=SCENES)
def result(request, tmp_path_factory):
    out = tmp_path_factory.mktemp("view") / request.param
    return ff.run(SCENES[request.param], accuracy=0.2, estimate=False, figures=False, out=out)


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    webdriver = pytest.importorskip("selenium.webdriver")
    if not shutil.which("chromium") or not (driver := shutil.which("chromedriver")):
        pytest.skip("chromium and chromedriver are not installed")
    options = webdriver.ChromeOptions()
    profile = tmp_path_factory.mktemp("profile")
    for argument in [*ARGUMENTS.split(), f"user-data-dir={profile}"]:
        options.add_argument(f"--{argument}")
    service = webdriver.ChromeService(driver)
    chrome = webdriver.Chrome(options=options, service=service)
    yield chrome
    chrome.quit()


def test_a_page_is_small_and_needs_no_network(result, tmp_path):
    """At most 5 MB for up to 60 states. The page loads nothing from elsewhere."""
    path = result.view(tmp_path / "impact.html")
    text = path.read_text("utf-8")
    assert path.stat().st_size < 5e6 and 3 < len(result.fields) <= 61
    assert not re.search(r'(src|href)="?https?:', text)
    assert result.view()._repr_html_().startswith("<iframe srcdoc=")


def test_the_picture_follows_slider_and_field(result, tmp_path, browser):
    """The picture is not blank, and differs for another state and another field. The cursor moves."""
    browser.get(result.view(tmp_path / "impact.html").as_uri())
    wait(browser, "return Number(document.body.dataset.state) > 0")  # state of the largest force
    move(browser, "state", 0)
    first, cursor = seen(browser), cursor_position(browser)
    last = len(result.fields.times) - 1
    move(browser, "state", last // 2)
    middle = seen(browser)
    assert len(np.unique(middle.reshape(-1, 3), axis=0)) > 200  # colours of the body
    assert (first != middle).any(axis=2).mean() > 0.01 and cursor_position(browser) > cursor
    move(browser, "field", "speed")
    assert (seen(browser) != middle).any(axis=2).mean() > 0.01
    choices = "return [...document.querySelectorAll('#field option')].map((one) => one.value)"
    assert browser.execute_script(choices) == list(states_of(result, revolved=True).fields)
    browser.find_element("id", "play").click()
    wait(browser, f"return document.body.dataset.state !== '{last // 2}'")


def test_a_moving_obstacle_moves(tmp_path, browser):
    """The grey pixels of a plane that comes up are higher in the picture at the end."""
    ball = ff.Ball(**BALL, position=(0, 0.051, 0))
    plane = ff.Plane(normal=(0, 1, 0), point=(0, -0.02, 0), motion=(0, "4*t", 0))
    scene = ff.Scene(bodies=[ball], obstacles=[plane], end_time=0.01, fields=10)
    result = ff.run(scene, accuracy=0.3, estimate=False, figures=False, out=tmp_path / "out")
    browser.get(result.view(tmp_path / "impact.html").as_uri())
    wait(browser, "return Number(document.body.dataset.state) > 0")
    rows = []
    for state in (0, len(result.fields.times) - 1):
        move(browser, "state", state)
        image = seen(browser).astype(int)
        grey = (np.ptp(image, axis=2) < 5) & (image[..., 0] < 245)
        rows.append(np.median(np.nonzero(grey)[0]))
    assert rows[1] < rows[0] - 10


def wait(browser, script, seconds=30):
    """Waits until a script of the page returns true."""
    end = time.monotonic() + seconds
    while not browser.execute_script(script):
        assert time.monotonic() < end, script
        time.sleep(0.1)


def move(browser, name, value):
    """Sets a control of the page as a user does."""
    script = (
        "const one = document.getElementById(arguments[0]); one.value = arguments[1];"
        "one.dispatchEvent(new Event('input')); one.dispatchEvent(new Event('change'));"
    )
    browser.execute_script(script, name, value)


def cursor_position(browser):
    """The position of the cursor in the figure [%]."""
    return float(
        browser.execute_script("return parseFloat(document.getElementById('cursor').style.left)")
    )


def seen(browser):
    """The plot without its controls (height, width, 3), once it does not change any more."""
    from PIL import Image

    last = None
    for _ in range(30):
        time.sleep(0.3)
        image = np.asarray(Image.open(io.BytesIO(browser.get_screenshot_as_png())).convert("RGB"))
        image = image[:-50, : int(0.6 * image.shape[1])]
        if last is not None and (image == last).all():
            return image
        last = image
    raise AssertionError("the picture does not come to rest")


def test_the_command_writes_a_page(result, tmp_path, capsys):
    assert main(["view", str(result.folder), "--html", str(tmp_path / "a.html")]) == 0
    assert (tmp_path / "a.html").exists() and "a.html" in capsys.readouterr().out
    assert main(["view", str(result.folder), "--field", "stress"]) == 10
    assert "stress" in capsys.readouterr().err and main(["view", str(tmp_path)]) == 14


def test_energy_density_is_that_of_the_history(tmp_path):
    """Its integral over the reference area is the elastic energy, to the error of its means."""
    record = ff.run(drop(), accuracy=0.05, estimate=False, figures=False, out=tmp_path / "run")
    history = record.history
    times = np.array(record.fields.times)
    k = int(np.argmin(abs(times - history.t[history.elastic.idxmax()])))
    state = vtu.read(vtu.series(record.folder / "fields.pvd")[k][1])
    corners = state.points[state.triangles]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    density = state.fields["energy_density"][state.triangles].mean(axis=1)
    energy = (abs(ax * by - ay * bx) / 2 * density).sum()
    copies = 2 if record.scene.get("symmetry") == "half" else 1
    assert copies * energy == pytest.approx(
        np.interp(times[k], history.t, history.elastic), rel=0.02
    )

"""Automatic values by dimensionless rules: penalty, slip velocity, element sizes, and the viscosity
of a loss factor. They are those of a disc, or a ball, that hits a plane.

The scales are c = sqrt(E/rho), with E the modulus in the impact, and the half-width b of the contact.
The contact of a disc lasts some T = 6.5 R/c (measured: 7.1 at v/c = 0.008, 6.0 at 0.125). So its peak
force is about pi m v/T and, by Hertz' b^2 = 4 R F/(pi E), b = 1.42 R sqrt(v/c) (less by at most the
root of 1 - nu^2). Its weight alone acts like v = 2 R g/c. The contact of a ball is Hertz': T = 5.09
(R/c) (c/v)^(1/5), b = 1.31 R (v/c)^(2/5), largest pressure 2 E b/(pi R), less by small powers of 1 -
nu^2. This holds up to v/c = 0.1 and beyond. Its weight alone acts like v = 1.31 c (R g/c^2)^(5/6).
"""

import math
from dataclasses import dataclass
from functools import cached_property

from ..failure import BadInput
from ..input.damping import Damping

__all__ = ["Impact", "made_for"]

# Element sizes in the bulk over the radius, and at the contact over its half-width, for an accuracy
# made_for() of CALIBRATED. The error is quadratic in both, and in the step (control.idp). They were
# calibrated over materials, laws, speeds, friction and exponents (docs/measurements/promise.md). Of
# the results that `accuracy` covers, the contact time above 1 % of the peak force is decisive; for
# it the step matters more than the mesh. Results that scatter more (accuracy_of) need about half the
# sizes and steps.
BULK, ARC, CALIBRATED = 0.32, 0.2, 5e-3
LARGEST = 0.5  # largest element over the radius, and over the half-width
FINEST = 1 / 20000  # smallest element over the radius
NARROWEST, WIDEST = 1e-3, 0.5  # bounds of the half-width over the radius
# Penetration by the pressure of the scene: b^2/R over this number. For a disc and the exponent 1 the
# penalty is then k = 35.7 E/b. For a ball it is a hundredth of the approach.
STIFF_DISC, STIFF_BALL = 71.4, 100.0
# On a given mesh that is too coarse for b, this number of its elements replaces b: single points
# would bounce on a stiffer penalty.
ELEMENTS = 3
# The penalty does not dissipate the energy that it stores. So the restitution of a damped body is
# too large, by 0.02 to 0.045 tan delta for viscous discs at v/c = 0.005 to 0.02. A penalty that is
# stiffer by this number times tan delta over the accuracy keeps this error near accuracy/10.
DAMPED = 0.4
STIFFEST_NU = 0.5 - 1e-9  # that has a bulk modulus
RELAXED = 0.1  # largest error of the complex shear modulus by steps, over the accuracy
# Frequency of the first mode over sqrt(mu/rho)/R, ovalling with two waves around: 2.336 (nu = 0) to
# 2.354 (0.5) for a free disc in plane strain, 2.59 to 2.67 for a free ball (Lamb).
OVALLING_DISC, OVALLING_BALL = 2.35, 2.65


def made_for(accuracy: float, accuracy_of: str) -> float:
    """Returns the accuracy for which elements and steps are made. accuracy.idp has the same rule."""
    return 2 * accuracy / (1 if accuracy_of == "promised" else 4)


@dataclass(frozen=True)
class Impact:
    """A disc, or a ball (`sphere`), that hits a plane.

    `closing` and `sliding` are the speeds [m/s] along and across the normal, `pressing` and
    `pulling` the accelerations [m/s2], `spin` the angular velocity [rad/s]. `endless` means that
    the motion is followed after the impact until it rests, `end_time` [s] until then.
    """

    sphere: bool
    radius: float
    young: float
    nu: float
    density: float
    closing: float
    accuracy: float
    accuracy_of: str = "promised"
    exponent: float = 1.0
    sliding: float = 0.0
    spin: float = 0.0
    pressing: float = 0.0
    pulling: float = 0.0
    end_time: float = 0.0
    endless: bool = False
    damping: Damping = Damping()
    hardness: float = math.inf  # mean pressure [Pa] of the contact of a metal that yields
    given_contact_size: float = 0.0  # of a mesh whose elements at the contact are given [m]

    @property
    def _shear(self) -> float:
        return self.young / (2 * (1 + self.nu))  # mu [Pa]

    @property
    def first_mode(self) -> float:
        """The angular frequency [1/s] of the first mode without damping."""
        mode = OVALLING_BALL if self.sphere else OVALLING_DISC
        return mode * math.sqrt(self._shear / self.density) / self.radius

    def viscosity(self, loss: float) -> float:
        """Returns the viscosity [Pa s] for the loss factor tan delta = eta omega/mu at the first
        mode.
        """
        return _rounded(loss * self._shear / self.first_mode)

    @property
    def relaxed_step(self) -> float:
        """The longest step [s] that is short enough for the branches, at omega = pi/T."""
        omega = math.pi / self._duration(self._in_impact[0])
        return self.damping.longest_step(self._shear, omega, RELAXED * self.accuracy)

    @property
    def loss_range(self) -> list[float]:
        """The frequencies [Hz] of an impact: a tenth to ten times that of the first mode."""
        frequency = self.first_mode / (2 * math.pi)
        return [_rounded(frequency / 10), _rounded(frequency * 10)]

    @cached_property
    def _in_impact(self) -> tuple[float, float]:
        """The modulus E [Pa] in the impact, and tan delta of shear.

        Damping stiffens a body. An impact is half a period of omega = pi/T. Moduli are absolute
        values of the complex ones.
        """
        young, tangent = self.young, 0.0
        if not self.damping:
            return young, tangent
        nu, mu = min(self.nu, STIFFEST_NU), self._shear
        wave = 2 * mu * (1 - nu) / (1 - 2 * nu)
        # A stiffer body has a shorter impact, which stiffens it further, each time by less.
        for _ in range(60):
            omega = math.pi / self._duration(young)
            shear = self.damping.shear(mu, omega)
            bulk = self.damping.wave(wave, omega) - 4 / 3 * shear
            young = abs(9 * bulk * shear / (3 * bulk + shear))
            tangent = shear.imag / shear.real
        return young, tangent

    def _share(self, young: float) -> float:
        """Returns the half-width over the radius for this modulus [Pa]."""
        c = math.sqrt(young / self.density)
        share = self._fall(c) / c
        share = 1.31 * share**0.4 if self.sphere else 1.42 * math.sqrt(share)
        return min(WIDEST, max(NARROWEST, share))

    @property
    def yielding_half_width(self) -> float:
        """The half-width a [m] of the contact, which is wider where a metal yields.

        A pressure H resists with pi a^2 H, or 2 a H, through the depth a^2/(2 R). The kinetic energy
        is pi a^4 H/(4 R) of a ball, 2 a^3 H/(3 R) of a disc.
        """
        pressure = self.density * self._fall(self._bar_speed) ** 2 / self.hardness
        share = math.pow(8 / 3 * pressure, 1 / 4)
        if not self.sphere:
            share = math.pow(3 * math.pi / 4 * pressure, 1 / 3)
        return max(self.half_width, self.radius * min(WIDEST, share))

    def _fall(self, c: float) -> float:
        """Returns the normal velocity [m/s] that makes as wide a contact, with the weight."""
        weight = self.radius * abs(self.pressing)
        like = 1.31 * c * (weight / c**2) ** (5 / 6) if self.sphere else 2 * weight / c
        return self.closing + like

    def _duration(self, young: float) -> float:
        """Returns the duration of contact [s] for this modulus [Pa]."""
        lasts = 5.09 * math.sqrt(1.31 / self._share(young)) if self.sphere else 6.5
        return lasts * self.radius / math.sqrt(young / self.density)

    @cached_property
    def half_width(self) -> float:
        """The half-width b of the contact [m]."""
        return self.radius * self._share(self._in_impact[0])

    def _pressure(self, half_width: float) -> float:
        """Returns the largest pressure [Pa] of a contact of this half-width [m]."""
        share = half_width / self.radius
        return self._in_impact[0] * share * (2 / math.pi if self.sphere else 0.5)

    @property
    def penalty(self) -> float:
        """The penalty k [Pa/m^m]: the pressure makes a small penetration."""
        b = max(
            self.yielding_half_width, min(WIDEST * self.radius, ELEMENTS * self.given_contact_size)
        )
        tangent = self._in_impact[1]
        stiff = STIFF_BALL if self.sphere else STIFF_DISC
        pressed = b**2 / self.radius / stiff / max(1 + tangent, DAMPED * tangent / self.accuracy)
        return _rounded(self._pressure(b) / pressed**self.exponent)

    @cached_property
    def _speed_along(self) -> float:
        """The tangential speed [m/s]. What is pulled along the plane after its impact has its speed
        after a way as long as the outline.
        """
        pull = abs(self.pulling)
        gained = (
            math.sqrt(4 * math.pi * self.radius * pull) if self.end_time else pull * self._lasts
        )
        return abs(self.sliding) + abs(self.spin) * self.radius + gained

    @property
    def _lasts(self) -> float:
        """The duration of contact of a disc [s], on the safe side for a ball."""
        return 6.5 * self.radius / self._bar_speed

    @property
    def _bar_speed(self) -> float:
        return math.sqrt(self._in_impact[0] / self.density)

    @property
    def slip_velocity(self) -> float:
        """A hundredth of the speeds [m/s]; a surface under normal load spreads at v b/R."""
        c = self._bar_speed
        spreading = self._fall(c) * self.half_width / self.radius
        return _rounded(max(1e-12 * c, 0.01 * max(self._speed_along, spreading)))

    @cached_property
    def mesh_size(self) -> float:
        """The element size in the bulk [m]."""
        size = self.radius * min(LARGEST, BULK * self._finer)
        return _rounded(max(size, self.given_contact_size))

    @cached_property
    def contact_mesh_size(self) -> float:
        """The element size at the contact [m]. Raises BadInput if it is too small to be meshed."""
        size = min(self.mesh_size, self.half_width * min(LARGEST, ARC * self._finer))
        if size < FINEST * self.radius:
            raise BadInput(
                f"contact_mesh_size: {size:.3g} m, which accuracy = {self.accuracy:g} requires, is too small "
                f"(accepted: from {FINEST * self.radius:.3g} m; a larger accuracy)"
            )
        return _rounded(size)

    @property
    def _finer(self) -> float:
        return math.sqrt(made_for(self.accuracy, self.accuracy_of) / CALIBRATED)

    @property
    def touch_arc(self) -> float:
        """The angle [rad] from the lowest point up to which the outline may come into contact: 1.5
        half-widths, or one and what rolls under the body during contact.

        What is pulled to the plane and followed after its impact rolls on: it has the whole circle.
        No size depends on the value of end_time.
        """
        followed = self.endless or (self.end_time > 0 and self.pressing > 0)
        if self._speed_along > 0 and followed:
            return math.pi
        width = self.yielding_half_width
        rolled = width + 0.4 * self._speed_along * self._lasts
        return min(math.pi, max(math.pi / 2 * width, rolled) / self.radius)


def _rounded(value: float) -> float:
    """Returns a value with twelve digits: a mesh changes with every digit."""
    return float(f"{value:.11e}")

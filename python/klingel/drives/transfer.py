"""Transfer functions of the differential drive of a wheel pair, Eqs (12) to (29), for one motor speed.
Polynomials are written out, so that nothing cancels numerically; `K(s)` is always a controller, `C(s)` Eq. (17).
Signals have the paper's names; u, Td, wd and Id are half differences of the pair, left minus right."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.polynomial import Polynomial

from klingel.drives.motor import torque_constant

if TYPE_CHECKING:
    from klingel.vehicle import Drive, InductionDrive

S = Polynomial([0.0, 1.0])


@dataclass(frozen=True)
class Rational:
    """A transfer function as two polynomials in s, lowest power first, from `input` to `output`."""

    numerator: Polynomial
    denominator: Polynomial
    input: str = "u"
    output: str = "y"

    def __call__(self, s: complex) -> complex:
        """The value at a complex frequency s [1/s]."""
        return complex(self.numerator(s) / self.denominator(s))

    def response(self, omega: np.ndarray) -> np.ndarray:
        """The frequency response at `omega` [rad/s]."""
        s = 1j * np.asarray(omega)
        return np.asarray(self.numerator(s) / self.denominator(s))

    def poles(self) -> np.ndarray:
        """The roots of the denominator [1/s]."""
        return np.asarray(self.denominator.roots())

    def coefficients(self) -> tuple[np.ndarray, np.ndarray]:
        """Numerator and denominator, highest power first, as scipy.signal and python-control take them."""
        return self.numerator.coef[::-1], self.denominator.coef[::-1]

    def to_control(self) -> Any:
        """The same as a `control.TransferFunction` with its input and output named."""
        import control

        return control.TransferFunction(*self.coefficients(), inputs=[self.input], outputs=[self.output])


@dataclass(frozen=True)
class WheelPair:
    """What Gw needs of the vehicle: Eq. (26) for the pair of wheels on one axle.

    wheel_inertia: Iwy of one wheel about its axle [kg m2]; radius: r0 [m]; speed: V [m/s]; longitudinal_creep: f11 of
    one wheel [N]. wd and Td are half differences, left minus right.
    """

    wheel_inertia: float
    radius: float
    speed: float
    longitudinal_creep: float

    @property
    def Gw(self) -> Rational:
        """wd/Td = 1/(Iwy s + f11 r0^2/V), Eq. (26): a torque forward turns the wheel forward, so plus."""
        creep = self.longitudinal_creep * self.radius**2 / self.speed
        return Rational(Polynomial([1.0]), self.wheel_inertia * S + creep, "Td", "wd")


@dataclass(frozen=True)
class TwoInputs:
    """Td of a wheel pair from what is commanded and from wd: the two terms of Eqs (24), (25) and (28)."""

    command: Rational
    speed: Rational

    def to_control(self) -> Any:
        """The same as a `control.TransferFunction` with both inputs and the output named."""
        import control

        parts = (self.command, self.speed)
        numerators, denominators = zip(*(part.coefficients() for part in parts), strict=True)
        names = [part.input for part in parts]
        return control.TransferFunction([list(numerators)], [list(denominators)], inputs=names, outputs=["Td"])


def _of_speed(transfer: Rational) -> Rational:
    return dataclasses.replace(transfer, input="wd", output="Td")


class ShaftTransfer(ABC):
    """Eqs (12) to (14), (16), (24), (25), (27) to (29) for a motor of any kind behind its gearbox and shaft."""

    transmission_stiffness: float
    transmission_damping: float

    @property
    @abstractmethod
    def A(self) -> Rational:
        """Air-gap torque at the wheel over what commands the motor."""

    @property
    @abstractmethod
    def C(self) -> Rational:
        """Torque at the wheel over rotor speed (wE)."""

    @property
    def _lag(self) -> Polynomial:
        """Denominator of A over that of C."""
        return Polynomial([1.0])

    @property
    def B(self) -> Rational:
        """Shaft torque over slip speed, KOUT/s + COUT, Eq. (16)."""
        return Rational(self.transmission_damping * S + self.transmission_stiffness, S)

    @property
    def _common(self) -> Polynomial:
        """Denominator of Gu and Gv: the C + B of Eqs (13) and (14) times both their denominators."""
        return (self.C.numerator * S + self.B.numerator * self.C.denominator) * self._lag

    @property
    def Gu(self) -> Rational:
        """TOUT over the command, A B/(C + B), Eq. (13)."""
        return Rational(self.A.numerator * self.B.numerator, self._common, self.A.input, "TOUT")

    @property
    def Gv(self) -> Rational:
        """TOUT/wOUT = - C B/(C + B), Eq. (14): a wheel that runs ahead is held back, so minus."""
        return Rational(-self.C.numerator * self.B.numerator * self._lag, self._common, "wOUT", "TOUT")

    def torque_plant(self, pair: WheelPair) -> Rational:
        """Td/u = Gu/(1 - Gv Gw), Eq. (27): the design plant of the torque loop."""
        return Rational(self.Gu.numerator * pair.Gw.denominator, self._closed(pair), "u", "Td")

    def speed_plant(self, pair: WheelPair) -> Rational:
        """wd/u = Gu Gw/(1 - Gv Gw), Eq. (29): the design plant of the speed loop."""
        return Rational(self.Gu.numerator, self._closed(pair), "u", "wd")

    def open_loop(self) -> TwoInputs:
        """Td = Gu u + Gv wd, Eq. (24)."""
        return TwoInputs(dataclasses.replace(self.Gu, input="u", output="Td"), _of_speed(self.Gv))

    def torque_loop(self, controller: Rational) -> TwoInputs:
        """Td = [Gu K/(1 + Gu K)] Td_command + [Gv/(1 + Gu K)] wd, Eq. (25), with the torque controller K(s)."""
        closed = self._common * controller.denominator + self.Gu.numerator * controller.numerator
        command = Rational(self.Gu.numerator * controller.numerator, closed, "Td_command", "Td")
        return TwoInputs(command, _of_speed(Rational(self.Gv.numerator * controller.denominator, closed)))

    def speed_loop(self, controller: Rational) -> TwoInputs:
        """Td = Gu K wd_command + (Gv - Gu K) wd, Eq. (28), with the speed controller K(s)."""
        gain = self.Gu.numerator * controller.numerator
        both = self._common * controller.denominator
        coupling = self.Gv.numerator * controller.denominator - gain
        return TwoInputs(Rational(gain, both, "wd_command", "Td"), _of_speed(Rational(coupling, both)))

    def _closed(self, pair: WheelPair) -> Polynomial:
        return self._common * pair.Gw.denominator - self.Gv.numerator


@dataclass(frozen=True)
class DriveTransfer(ShaftTransfer):
    """Armature voltage u and wheel speed wOUT to shaft torque TOUT at one field current.

    >>> from klingel import library
    >>> vehicle = library.vehicle("mechatronic_irw")
    >>> transfer = DriveTransfer.of(vehicle.drive, field_current=6.05)
    >>> round(transfer.Gu(0j).real, 1)   # KT/(N Ra) with the wheel held: N m/V
    56.2
    >>> transfer.open_loop().to_control().input_labels
    ['u', 'wd']
    """

    armature_resistance: float
    armature_inductance: float
    gear_ratio: float
    rotor_inertia: float
    rotor_damping: float
    transmission_stiffness: float
    transmission_damping: float
    torque_constant: float

    @classmethod
    def of(cls, drive: Drive, *, field_current: float) -> DriveTransfer:
        """The transfer functions of a drive at a field current If [A]."""
        return cls(
            armature_resistance=drive.armature_resistance,
            armature_inductance=drive.armature_inductance,
            gear_ratio=drive.gear_ratio,
            rotor_inertia=drive.rotor_inertia,
            rotor_damping=drive.rotor_damping,
            transmission_stiffness=drive.transmission_stiffness,
            transmission_damping=drive.transmission_damping,
            torque_constant=torque_constant(drive, field_current),
        )

    @property
    def _armature(self) -> Polynomial:
        return self.armature_inductance * S + self.armature_resistance

    @property
    def A(self) -> Rational:
        """Air-gap torque at the wheel over voltage, (KT/N)/(La s + Ra), Eq. (15)."""
        return Rational(Polynomial([self.torque_constant / self.gear_ratio]), self._armature, "Va", "torque")

    @property
    def C(self) -> Rational:
        """Torque at the wheel over rotor speed (wE), (JM s + CM)/N^2 + (KT/N) A, Eq. (17)."""
        rotor = self.rotor_inertia * S + self.rotor_damping
        numerator = (rotor * self._armature + self.torque_constant**2) / self.gear_ratio**2
        return Rational(numerator, self._armature, "wE", "torque")

    def current_plant(self, pair: WheelPair) -> Rational:
        """Half difference of the armature currents over u, from Eqs (2), (10) and (27): plant of a current loop."""
        rotor = self.rotor_inertia * S + self.rotor_damping
        torque = self.torque_plant(pair)
        numerator = rotor * torque.denominator + self.gear_ratio * self.torque_constant * torque.numerator
        return Rational(numerator, (rotor * self._armature + self.torque_constant**2) * torque.denominator, "u", "Id")


@dataclass(frozen=True)
class InductionTransfer(ShaftTransfer):
    """Torque command u (at the wheel) and wheel speed wOUT to shaft torque TOUT of an induction drive within limits.

    A = a/(s + a) of the closed current loops instead of Eq. (15), and C = (JM s + CM)/N^2: the control takes the
    back-EMF out, and with it what damps the shaft.

    >>> from klingel import library
    >>> transfer = InductionTransfer.of(library.drive("induction_160kw"))
    >>> round(abs(transfer.Gu(0j)), 12)
    1.0
    """

    torque_bandwidth: float
    gear_ratio: float
    rotor_inertia: float
    rotor_damping: float
    transmission_stiffness: float
    transmission_damping: float

    @classmethod
    def of(cls, drive: InductionDrive) -> InductionTransfer:
        """The transfer functions of a drive."""
        return cls(**{field.name: getattr(drive, field.name) for field in dataclasses.fields(cls)})

    @property
    def _lag(self) -> Polynomial:
        return S / self.torque_bandwidth + 1.0

    @property
    def A(self) -> Rational:
        """Air-gap torque at the wheel over its command, a/(s + a)."""
        return Rational(Polynomial([1.0]), self._lag, "torque_command", "torque")

    @property
    def C(self) -> Rational:
        """Torque at the wheel over rotor speed (wE), (JM s + CM)/N^2."""
        rotor = self.rotor_inertia * S + self.rotor_damping
        return Rational(rotor / self.gear_ratio**2, Polynomial([1.0]), "wE", "torque")

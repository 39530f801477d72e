"""Types of the arguments of observers, and of contact laws written in Python, for type checkers."""
from __future__ import annotations

import decimal
from collections.abc import Callable
from typing import Protocol, Union

Number = Union[float, decimal.Decimal]  #: float in double, with all digits a Decimal in the wider precisions
Vector = tuple[Number, Number, Number]


class Impact(Protocol):
    """The impact that an observer receives, in SI units. The normal points from the partner to the ball."""
    index: int  #: from 0
    time: Number
    ball: int
    with_wall: bool
    partner: int  #: number of a ball, or of a wall
    normal: Vector
    approach_speed: Number
    slip_speed: Number  #: before the impact
    separation_speed: Number
    restitution_tangential: Number
    normal_impulse: Number
    tangential_impulse: Number
    milling_dose: Number
    supplied_energy: Number
    wall_work: Number


class Running(Protocol):
    """The run that an observer receives."""
    time: Number  #: [s]
    ball_count: int

    def ball(self, k: int) -> tuple[Vector, Vector, Vector]:
        """Position [m], velocity [m/s] and spin [rad/s] of a ball, inertial. Raises IndexError when there is no such ball."""

    def stop(self) -> None:
        """Ends the run after this impact."""


class RestitutionLaw:
    """A law of one function of the approach speed [m/s], with Coulomb friction as in (2.24')."""

    def __init__(self, restitution: Callable[[Number], Number], friction: str, min_tangential: str = "-1"):
        self.restitution, self._friction, self._least = restitution, friction, min_tangential

    def restitution_of_slip(self, normal_change: Number, slip_speed: Number, compliance: Number) -> Number:
        kind = type(slip_speed)
        return max(kind(self._least), 1 - kind(self._friction) * compliance * normal_change / slip_speed) if slip_speed > 0 else kind(0)


class ContactLaw(Protocol):
    """A contact law written in Python. Both functions are called for every impact to which the law applies."""

    def restitution(self, approach_speed: Number) -> Number:
        """Normal restitution, from 0 to 1, for an approach speed in m/s."""

    def restitution_of_slip(self, normal_change: Number, slip_speed: Number, compliance: Number) -> Number:
        """e_t, the fraction of the slip that remains after the impact, from -1 to 1. (2.24')

        normal_change  |g_n| + g_n' [m/s]: the normal impulse over the effective mass
        slip_speed     |g_t| [m/s]
        compliance     1 + M/(m_i J_i) + M/(m_j J_j), of a wall 1 + 1/J_i"""

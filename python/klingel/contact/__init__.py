"""Profiles of wheels and rails as people use them: named ones, measured ones from files, checked when made.
Wheel: y from the tape circle, + to the field side, z radius increment. Rail: y from its axis, z down from its top."""

from klingel.contact.creep import creep_force
from klingel.contact.options import AS_PUBLISHED, CreepOptions
from klingel.contact.pair import Prepared, WheelRailPair
from klingel.contact.profile import Profile

__all__ = ["AS_PUBLISHED", "CreepOptions", "Prepared", "Profile", "WheelRailPair", "creep_force"]

"""Wheel on rail for people: profiles by name or from files, pairs of them in contact, creep forces.
Wheel: y from the tape circle, + to the field side, z radius increment. Rail: y from its axis, z down from its top."""

from klingel.contact.creep import creep_force
from klingel.contact.options import AS_PUBLISHED, CreepOptions
from klingel.contact.pair import Prepared, WheelRailPair
from klingel.contact.profile import Profile
from klingel.contact.standard import STANDARD, profile_of

__all__ = [
    "AS_PUBLISHED",
    "STANDARD",
    "CreepOptions",
    "Prepared",
    "Profile",
    "WheelRailPair",
    "creep_force",
    "profile_of",
]

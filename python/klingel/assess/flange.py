"""Whether wheels touched their rails with the root or the flank of the flange, and for how long.
The same definition for every assessment."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import xarray as xr

from klingel.assess.header import Wheelset, values
from klingel.assess.signals import Mask, longer_than

CARRYING_FORCE = 1.0e3
"""A steep patch counts when it carries more than this [N]."""
CARRYING_TIME = 0.1
"""... for longer than this [s]."""
FLANGE_ANGLE = math.radians(60.0)
"""A carrying patch steeper than this lies on the flange, else in the root [rad]. The flank of S1002 has 70 deg; in
two-point contact the steeper patch of a root contact reaches 50 to 55 deg."""


def flange_contact(
    result: xr.Dataset, wheelsets: Iterable[Wheelset], windows: Mapping[str, Mask], interval: float
) -> str:
    """`flange`, `root` or nothing: the steepest contact that carried for longer than `CARRYING_TIME` without a break.

    Args:
        result: a run, with `steep_force` (of patches steeper than 15 deg) and `contact_angle` of every wheel.
        wheelsets: to look at.
        windows: by wheelset, the samples that count.
        interval: of the samples [s].

    Returns:
        The kind of contact, empty for none.

    Raises:
        InputError: a channel is missing.
    """
    kinds = set()
    for wheelset in wheelsets:
        for wheel in (wheelset.left, wheelset.right):
            carrying = (values(result, f"{wheel}.steep_force") > CARRYING_FORCE) & windows[wheelset.name]
            flank = carrying & (values(result, f"{wheel}.contact_angle") > FLANGE_ANGLE)
            if longer_than(flank, interval, CARRYING_TIME):
                kinds.add("flange")
            elif longer_than(carrying, interval, CARRYING_TIME):
                kinds.add("root")
    return "flange" if "flange" in kinds else "root" if "root" in kinds else ""

"""Where the energy of a run came from and where it went: one table out of the channels `energy.*`.
Derived in docs/theory/energy.md; the accounts are booked in the core by the power of every law."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import xarray as xr

from klingel.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

Kind = Literal["in", "out", "stored"]

WH = 3600.0
"""One watt hour [J]."""


@dataclass(frozen=True)
class Account:
    """One account: channel `energy.<name>`, what it is, and whether it counts what comes in, goes out or is stored."""

    name: str
    kind: Kind
    label: str

    @property
    def channel(self) -> str:
        return f"energy.{self.name}"

    @property
    def sign(self) -> float:
        """In the balance: in - out - stored = 0."""
        return 1.0 if self.kind == "in" else -1.0


ACCOUNTS: tuple[Account, ...] = (
    Account("traction", "in", "electrical, taken by the motors"),
    Account("actuators", "in", "mechanical work of the steering actuators"),
    Account("hold", "in", "force that holds the speed"),
    Account("wind", "in", "wind on the body"),
    Account("rails", "in", "rails that move or climb cant ramps"),
    Account("gradient", "in", "weight along the grade"),
    Account("guides", "in", "guides of motions that are kept"),
    Account("regeneration", "out", "electrical, returned by the motors"),
    Account("copper_armature", "out", "copper of the armatures"),
    Account("copper_field", "out", "copper of the fields"),
    Account("copper_stator", "out", "copper of the stators"),
    Account("copper_rotor", "out", "copper of the rotors"),
    Account("motor_friction", "out", "friction of the motors' rotors"),
    Account("transmission", "out", "damping of the shafts"),
    Account("running_resistance", "out", "running resistance"),
    Account("contact_friction", "out", "friction of wheels on rails"),
    Account("contact_damping", "out", "damping of the contacts"),
    Account("suspension", "out", "dampers of the suspension"),
    Account("contact_elastic", "stored", "elastic contacts"),
    Account("kinetic", "stored", "motion"),
    Account("potential", "stored", "height"),
    Account("elastic", "stored", "springs"),
    Account("magnetic", "stored", "windings"),
)
"""Every account that a run may have, in the order of tables and figures."""


def accounts_of(result: xr.Dataset) -> tuple[Account, ...]:
    """The accounts that a result has; errors: InputError for a run without."""
    found = tuple(account for account in ACCOUNTS if account.channel in result.data_vars)
    if not found:
        raise InputError.single("energy", None, "was not booked", remedy="run the scenario with energy=True")
    return found


def energy(result: xr.Dataset, *, start: float | None = None, end: float | None = None) -> pd.DataFrame:
    """The energy account of a run, or of the part of it between two times [s].

    Returns one row an account and a last row `residual`, what does not close; columns `kind` ("in", "out", "stored":
    grown), `what` in words, `energy_kJ`, `energy_kWh`, and `share`, of the energy turned over: of all that came in, or
    was given up where something stored shrank, or came back on an account that usually takes.
    Errors: InputError for a run without energies, for times outside it.

    >>> import numpy as np, xarray as xr
    >>> channels = {"traction": 100e3, "running_resistance": 60e3, "kinetic": 39e3, "residual": 1e3}
    >>> rising = {f"energy.{name}": ("time", [0.0, value]) for name, value in channels.items()}
    >>> table = energy(xr.Dataset(rising, coords={"time": [0.0, 10.0]}))
    >>> table[["kind", "energy_kJ", "share"]]
                            kind  energy_kJ  share
    account
    traction                  in      100.0   1.00
    running_resistance       out       60.0   0.60
    kinetic               stored       39.0   0.39
    residual            residual        1.0   0.01
    """
    import pandas as pd

    found = accounts_of(result)
    first, last = _window(result, start, end)
    rows = list(_rows(result, found, first, last))
    table = pd.DataFrame(rows, columns=["account", "kind", "what", "energy_kJ"]).set_index("account")
    signs = np.array([account.sign for account in found])
    given = signs * table["energy_kJ"].to_numpy()[:-1]
    turned = float(given[given > 0.0].sum())
    table["energy_kWh"] = table["energy_kJ"] / WH
    table["share"] = table["energy_kJ"] / turned if turned > 0.0 else 0.0
    return table


def _rows(
    result: xr.Dataset, found: tuple[Account, ...], first: int, last: int
) -> Iterator[tuple[str, str, str, float]]:
    def grown(channel: str) -> float:
        values = result[channel].to_numpy()
        return float(values[last] - values[first]) / 1e3

    for account in found:
        yield account.name, account.kind, account.label, grown(account.channel)
    yield "residual", "residual", "what does not close", grown("energy.residual")


def _window(result: xr.Dataset, start: float | None, end: float | None) -> tuple[int, int]:
    """First and last sample between two times."""
    time = result["time"].to_numpy()
    begin, stop = time[0] if start is None else start, time[-1] if end is None else end
    if not time[0] <= begin < stop <= time[-1]:
        remedy = f"give times between {time[0]:g} and {time[-1]:g} s, the first one earlier"
        raise InputError.single("start, end", f"{begin:g}, {stop:g}", "is no part of the run [s]", remedy=remedy)
    return int(np.searchsorted(time, begin)), int(np.searchsorted(time, stop, side="right") - 1)


__all__ = ["ACCOUNTS", "Account", "accounts_of", "energy"]

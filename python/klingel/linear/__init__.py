"""Linear analysis of the same model that runs: steady states, state space, modes, loci, critical speeds, responses.
Equations beside the code and in docs/theory/linear.md."""

from klingel.linear.critical import CriticalSpeed, critical_speed
from klingel.linear.limit_cycle import Bifurcation, bifurcation
from klingel.linear.locus import RootLocus, root_locus
from klingel.linear.model import LinearModel, Signal
from klingel.linear.modes import Mode, modes
from klingel.linear.operating import Steady, steady_spec, steady_state, steady_states
from klingel.linear.statespace import linearise

__all__ = [
    "Bifurcation",
    "CriticalSpeed",
    "LinearModel",
    "Mode",
    "RootLocus",
    "Signal",
    "Steady",
    "bifurcation",
    "critical_speed",
    "linearise",
    "modes",
    "root_locus",
    "steady_spec",
    "steady_state",
    "steady_states",
]

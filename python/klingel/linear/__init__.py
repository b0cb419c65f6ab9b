"""Linear analysis of the same model that runs: steady states, state space, modes, loci, critical speeds, responses.
Equations beside the code and in docs/theory/linear.md."""

from klingel.linear.critical import CriticalSpeed, critical_speed
from klingel.linear.limit_cycle import Bifurcation, bifurcation
from klingel.linear.locus import RootLocus, root_locus
from klingel.linear.measured import measured_response
from klingel.linear.model import LinearModel, Signal
from klingel.linear.modes import Mode, modes
from klingel.linear.operating import steady_spec
from klingel.linear.random import random_response
from klingel.linear.response import frequency_response, irregularity
from klingel.linear.sensitivity import eigenvalue_sensitivities, steady_sensitivities
from klingel.linear.statespace import linearise
from klingel.linear.steady import Steady, steady_state, steady_states

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
    "eigenvalue_sensitivities",
    "frequency_response",
    "irregularity",
    "linearise",
    "measured_response",
    "modes",
    "random_response",
    "root_locus",
    "steady_sensitivities",
    "steady_spec",
    "steady_state",
    "steady_states",
]

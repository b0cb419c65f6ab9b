"""Linear analysis of the same model that runs: steady states, state space, modes, loci, critical speeds, responses.
Equations beside the code and in docs/theory/linear.md."""

from klingel.linear.model import LinearModel, Signal
from klingel.linear.operating import Steady, steady_spec, steady_state, steady_states
from klingel.linear.statespace import linearise

__all__ = ["LinearModel", "Signal", "Steady", "linearise", "steady_spec", "steady_state", "steady_states"]

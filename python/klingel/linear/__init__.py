"""Linear analysis of the same model that runs: steady states, state space, modes, root loci, critical speeds, responses.
Equations beside the code and in docs/theory/linear.md."""

from klingel.linear.linearise import linearise
from klingel.linear.model import LinearModel, Signal
from klingel.linear.operating import Steady, steady_spec, steady_state, steady_states

__all__ = ["LinearModel", "Signal", "Steady", "linearise", "steady_spec", "steady_state", "steady_states"]

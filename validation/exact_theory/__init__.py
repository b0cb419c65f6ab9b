"""The exact theory itself: its grid convergence, and its creepages without units."""

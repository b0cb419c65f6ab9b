"""How much each creep force law errs against the exact theory."""

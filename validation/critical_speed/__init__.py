"""Linear critical speed of the passive coach over conicity."""

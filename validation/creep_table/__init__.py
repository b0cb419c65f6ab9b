"""The table of creep forces against the exact theory that it was made with."""

"""Creep curves of every law over the whole range of creepages, and the exact theory's."""

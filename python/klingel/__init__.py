"""Klingel: simulator and design bench for mechatronic railway vehicles.
Names are resolved on first use, so that `import klingel` stays quick."""

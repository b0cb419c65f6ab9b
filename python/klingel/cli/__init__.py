"""Command line of Klingel."""


def main() -> None:
    """Run the command line."""

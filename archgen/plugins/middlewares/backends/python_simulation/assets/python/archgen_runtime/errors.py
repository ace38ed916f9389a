"""What can go wrong in a run."""


class SimulationError(Exception):
    """Something in a run went wrong: in the scenario, in a behaviour, or in how it was used."""

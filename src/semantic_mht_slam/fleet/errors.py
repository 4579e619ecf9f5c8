"""What ends run_drive with a message."""


class FleetError(Exception):
    """The text is one line for the user: what is wrong, where, and how to mend it."""

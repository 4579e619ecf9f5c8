"""What a user handed over and cannot be used."""


class RelayError(Exception):
    """The text is one line for the user: what is wrong, where, and how to mend it."""

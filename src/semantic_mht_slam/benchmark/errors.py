"""What ends the benchmark with a message."""


class InputError(Exception):
    """Something that the user handed over cannot be used; the message names the file or option and the fix."""

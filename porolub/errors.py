"""The ways a run can end badly, each with the exit code the command line returns for it."""


class PorolubError(Exception):
    """Base of all errors a user can meet; the message is one sentence they can act on."""

    exit_code = 1


class SceneError(PorolubError):
    """The input is wrong: names the key, the value and what is allowed. Exit code 2."""

    exit_code = 2


class SolveError(PorolubError):
    """A solve failed: says what failed, where, and what to try. Exit code 3."""

    exit_code = 3


class Interrupted(PorolubError):
    """The run was told to stop: says how to go on. Exit code 130."""

    exit_code = 130

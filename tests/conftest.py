"""What holds for all tests."""

import pytest
from hypothesis import settings

from railride.cli import main

# No test depends on the clock, and each run tries the same examples.
settings.register_profile("railride", deadline=None, derandomize=True)
settings.load_profile("railride")


@pytest.fixture
def run(capsys):
    """Run a command in this process: exit code, standard output, standard error."""

    def call(*arguments):
        with pytest.raises(SystemExit) as stopped:
            main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return stopped.value.code or 0, out, err

    return call

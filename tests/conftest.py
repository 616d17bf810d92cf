"""What holds for all tests."""

from hypothesis import settings

# No test depends on the clock, and each run tries the same examples.
settings.register_profile("railride", deadline=None, derandomize=True)
settings.load_profile("railride")

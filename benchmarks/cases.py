"""All comparisons, in the order of the results."""

from __future__ import annotations

import derivation
import frequency
import growth
import peer_rides
import records
import rides
import studies
import sweeps
from measure import Case

CASES: dict[str, Case] = {
    **rides.CASES,
    **peer_rides.CASES,
    **derivation.CASES,
    **growth.CASES,
    **frequency.CASES,
    **records.CASES,
    **studies.CASES,
    **sweeps.CASES,
}
"""Name to the case and the number of its steps."""

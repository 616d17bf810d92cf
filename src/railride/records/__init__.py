"""Acceleration records from files as people have them.

The stages: table → columns and clock → rows without a number → pieces between gaps → an even rate
→ a :class:`~railride.comfort.record.AccelerationRecord`. Nothing is bridged: a gap ends a piece.
"""

from railride.records.read import read_record

__all__ = ["read_record"]

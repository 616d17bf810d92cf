"""Columns of numbers from a file as people have it, every fault named by row and column.

Text in any of the usual dialects (:mod:`~railride.tables.text`), Parquet, WAV, MATLAB and HDF5 all
become one :class:`NumberTable`; what the numbers mean is for the reader of records or of tracks.
"""

from railride.tables.files import read_table
from railride.tables.table import Column, NumberTable, is_missing, split_heading

__all__ = ["Column", "NumberTable", "is_missing", "read_table", "split_heading"]

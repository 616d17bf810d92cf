"""Parquet files, by pyarrow."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from railride.tables.table import Column, NumberTable


def read_parquet(path: Path) -> NumberTable:
    """Read the flat columns of a Parquet file; a column of lists or records is left out.

    path: an existing file. A time of day becomes ns since 1970, whatever its resolution.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pq.read_table(path)
    columns, left_out = [], []
    for field, chunks in zip(table.schema, table.columns, strict=True):
        kind = field.type
        if pa.types.is_nested(kind) or pa.types.is_binary(kind):
            left_out.append(field.name)
            continue
        if pa.types.is_decimal(kind):
            values = chunks.cast(pa.float64()).to_numpy()
        elif pa.types.is_integer(kind) and chunks.null_count:
            values = np.array(chunks.to_pylist(), dtype=object)  # whose texts keep every digit
        else:
            values = chunks.to_numpy()
        columns.append(Column.of(field.name, values))
    remarks = [f"the column {name!r} holds lists or records and was left out" for name in left_out]
    return NumberTable(str(path), tuple(columns), remarks=tuple(remarks))

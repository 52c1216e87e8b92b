"""Records as columns."""

from collections.abc import Mapping

try:
    import numpy
except ImportError:  # the client works without it
    numpy = None


def _flat(record):
    flat = {}
    for key, value in record.items():
        if isinstance(value, dict):
            flat.update({f"{key}_{inner}": item for inner, item in _flat(value).items()})
        else:
            flat[key] = value
    return flat


def _column(values):
    """An array where the values have one type; null among numbers is nan."""
    if numpy is None:
        return values
    numbers = [value for value in values if value is not None]
    if numbers and all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in numbers):
        if len(numbers) == len(values) and all(isinstance(value, int) for value in numbers):
            return numpy.array(values)
        return numpy.array([numpy.nan if value is None else value for value in values], dtype=float)
    if values and all(isinstance(value, (str, bool)) for value in values):
        return numpy.array(values)
    if values and all(isinstance(value, list) for value in values):
        try:
            return numpy.array(values, dtype=float)
        except (ValueError, TypeError):
            pass
    return numpy.array(values, dtype=object)


class Table(Mapping):
    """Columns by name, as arrays or lists; `rows()` has the records as they came."""

    def __init__(self, records, columns=()):
        self._records = list(records)
        flat = [_flat(record) for record in self._records]
        names = dict.fromkeys(columns)
        for record in flat:
            names.update(dict.fromkeys(record))
        self._columns = {name: _column([record.get(name) for record in flat]) for name in names}

    def __getitem__(self, name):
        return self._columns[name]

    def __getattr__(self, name):
        try:
            return self.__dict__["_columns"][name]
        except KeyError:
            raise AttributeError(f"no column {name!r}; there are {', '.join(self.__dict__.get('_columns', ()))}") from None

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        """The number of rows."""
        return len(self._records)

    def __bool__(self):
        return bool(self._records)

    def __repr__(self):
        return f"<Table of {len(self)} rows: {', '.join(self._columns)}>"

    @property
    def columns(self):
        """The names of the columns."""
        return list(self._columns)

    def rows(self):
        """The records, a dict for each row."""
        return list(self._records)

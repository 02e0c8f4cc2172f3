"""Problems as TOML: what Python's library reads, but does not write."""

import json
import math
from typing import Any, List, Mapping


def dumps(table: Mapping[str, Any]) -> str:
    """A nested dict of numbers, strings, booleans, lists and dicts as TOML."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in table.items() if value is not None)


def _key(key: Any) -> str:
    return json.dumps(str(key), ensure_ascii=False)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        pairs = (f"{_key(key)} = {_value(item)}" for key, item in value.items() if item is not None)
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if hasattr(value, "tolist"):
        return _value(value.tolist())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if hasattr(value, "__fspath__"):
        return json.dumps(str(value), ensure_ascii=False)
    try:
        items: List[Any] = list(value)
    except TypeError:
        raise TypeError(f"a value of type {type(value).__name__} cannot stand in a problem") from None
    return "[" + ", ".join(map(_value, items)) + "]"


def _number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(value)

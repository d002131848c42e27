"""The command `prob-water`."""

from typing import Any

from validation.support.paths import ROOT

COMMAND = ROOT / "target/release/prob-water"


def flags(parameters: dict[str, Any]) -> list[str]:
    """Parameters as the command takes them."""
    words = {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in parameters.items()}
    return [part for name, word in words.items() for part in (f"--{name.replace('_', '-')}", word)]

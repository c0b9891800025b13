"""Files that are not what they should be, and how their failure is told: in one sentence."""

from pathlib import Path

BASEMENT = Path(__file__).parents[2] / "datasets" / "flynn_basement"
ROOM = (
    '{"features": [{"properties": {"kind": "boundary"}, "geometry": {"type": "Polygon",'
    ' "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]}}]}'
)


def flaser(time: float, ranges: str = "1.01 2.02 3.03 2.04") -> str:
    return f"FLASER 4 {ranges} 0 0 0 {time} 0 0 {time} nohost {time}\n"


def log(folder: Path, *lines: str) -> Path:
    path = folder / "hall.log"
    path.write_text("".join(lines))
    return path


def one_sentence(text: str) -> bool:
    return text.startswith("roomsketch: ") and text.count("\n") == 1 and "Traceback" not in text

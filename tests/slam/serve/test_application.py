"""The routes, asked as a browser and as a stranger would ask them."""

import json
import shutil
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import uvicorn
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin

from slam.result_folder import Source
from slam.serve.application import application
from slam.serve.door import address_of, open_door
from slam.serve.gallery import Gallery, Shown
from slam.serve.messages import unpack
from slam.serve.replay import replay
from slam.serve.truth import Truth
from slam.serve.uploads import Limits
from tests.stories.command_line import run

BASEMENT = Path(__file__).parents[3] / "datasets" / "flynn_basement"
LIMITS = Limits(files=3, megabytes=1, megabytes_unpacked=2, seconds_sending=3)


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("basement") / "result"
    assert run("merge", BASEMENT, "--out", folder).code == 0
    return folder


@pytest.fixture(scope="module")
def address(result: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A server that shows the basement's result, with narrow limits."""
    gallery = Gallery(tmp_path_factory.mktemp("scratch"), LIMITS)
    shown = Shown(Source(result, None), True, Truth.beside(BASEMENT))
    with open_door("127.0.0.1", 0) as door:
        made = application(gallery, shown, "127.0.0.1")
        server = uvicorn.Server(uvicorn.Config(made, log_level="error", ws="websockets-sansio"))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [door]})
        thread.start()
        while not server.started:
            time.sleep(0.01)
        yield address_of(door, "127.0.0.1")
        server.should_exit = True
        thread.join()


@pytest.fixture
def client(address: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=address, timeout=120) as client:
        yield client


def messages(address: str, number: int) -> list[dict[str, Any]]:
    """Every head of a run, up to its end."""
    with connect(f"{address.replace('http', 'ws')}runs/{number}/live", max_size=None) as socket:
        return [unpack(message)[0] for message in socket if isinstance(message, bytes)]


def upload(client: httpx.Client, *files: tuple[str, bytes]) -> httpx.Response:
    return client.post("runs", files=[("files", (name, content)) for name, content in files])


def test_a_result_is_told_from_its_files_with_scans_map_report_and_truth(address: str, client: httpx.Client) -> None:
    told = messages(address, 1)
    kinds = [head["kind"] for head in told]
    assert kinds == ["opening", "poses", "room", "report", "scan", "scan", "scan", "truth", "done"]
    assert told[3]["counts"]["scans"] == 3
    assert 0 < told[7]["scores"]["map"]["iou"] < 1
    assert client.get("runs").json()["runs"] == [{"number": 1, "name": "result", "state": "done"}]


@pytest.mark.parametrize("path", ["", "runs", "page/main.js", "page/style.css", "nothing"])
def test_every_answer_is_sealed(client: httpx.Client, path: str) -> None:
    headers = client.get(path).headers
    assert "default-src 'none'" in headers["content-security-policy"]
    assert "unsafe" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["cross-origin-resource-policy"] == "same-origin"


def test_strangers_are_refused_at_every_door(address: str, client: httpx.Client) -> None:
    assert client.get("runs", headers={"Host": "evil.example"}).status_code == 403
    assert client.post("runs", headers={"Origin": "http://evil.example"}).status_code == 403
    with pytest.raises(InvalidStatus), connect(
        f"{address.replace('http', 'ws')}runs/1/live", origin=Origin("http://evil.example")
    ):  # fmt: skip
        pass


def test_what_is_not_there_is_said_to_be_missing(address: str, client: httpx.Client) -> None:
    assert client.get("runs/9/files/geojson").json() == {"reason": "there is no run 9"}
    assert client.get("runs/1/files/doc").status_code == 404
    assert client.get("page/%2e%2e/application.py").status_code == 404
    assert client.get("page/..%2fapplication.py").status_code == 404
    with connect(f"{address.replace('http', 'ws')}runs/9/live") as socket, pytest.raises(ConnectionClosed) as closed:
        socket.recv()
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == 4404


def test_both_planners_answer_and_say_why_they_do_not(client: httpx.Client) -> None:
    messages(str(client.base_url), 1)
    question = {"robot": "disc:0.15", "start": [0, 0], "goal": [1.5, -2.5]}
    for planner in ("cones", "configuration-space"):
        answer = client.post("runs/1/route", json={**question, "planner": planner}).json()
        assert answer["answer"] == "path"
        assert answer["length"] >= 2.9
        assert answer["seconds"] > 0
        assert answer["outline"]["radius"] == 0.15
        outside = client.post("runs/1/route", json={**question, "planner": planner, "goal": [50, 50]}).json()
        assert outside["answer"] == "refused"
        assert "goal (50, 50)" in outside["reason"]
        nobody = client.post("runs/1/route", json={**question, "planner": planner, "robot": "disc:-1"}).json()
        assert nobody == {"answer": "refused", "reason": "a disc needs a radius above 0, but has -1"}


@pytest.mark.parametrize(
    "body", ["", "[]", "{}", '{"planner": "magic", "robot": "", "start": [0, 0], "goal": [0, 0]}', "x" * 5000]
)
def test_what_is_no_question_is_refused(client: httpx.Client, body: str) -> None:
    messages(str(client.base_url), 1)
    answer = client.post("runs/1/route", content=body)
    assert answer.status_code in {400, 413}
    assert answer.json()["reason"]


def test_a_recording_from_outside_is_merged_and_can_be_taken_away(address: str, client: httpx.Client) -> None:
    files = [(name, (BASEMENT / name).read_bytes()) for name in ("recording.toml", "readings.csv")]
    number = upload(client, *files).json()["number"]
    told = messages(address, number)
    assert [head["kind"] for head in told][-1] == "done"
    assert sum(head["kind"] == "scan" for head in told) == 3
    ours = json.loads((BASEMENT / "truth.geojson").read_text())
    taken = client.get(f"runs/{number}/files/geojson")
    assert taken.headers["content-disposition"] == 'attachment; filename="map.geojson"'
    assert taken.json()["type"] == ours["type"] == "FeatureCollection"


def test_a_file_that_lies_elsewhere_is_never_read(address: str, client: httpx.Client) -> None:
    toml = b'name = "thief"\nreadings = "/etc/passwd"\n[sensor]\nkind = "lidar"\nmax_range = 9.0\n'
    number = upload(client, ("recording.toml", toml), ("readings.csv", b"")).json()["number"]
    reason = messages(address, number)[-1]["reason"]
    assert "root" not in reason
    assert "may lie outside the folder" in reason


@pytest.mark.parametrize(
    ("files", "status", "reason"),
    [
        ([], 400, "no file was sent"),
        ([("a.csv", b"1")] * 2, 400, "two of the files have the same name"),
        ([(f"{i}.csv", b"1") for i in range(4)], 400, "Too many files"),
        ([("../../.bashrc", b"1")], 415, "bashrc is no recording"),
        ([("big.csv", bytes(2 << 20))], 413, "at most 1 MB"),
    ],
)
def test_uploads_are_bounded(client: httpx.Client, files: list[tuple[str, bytes]], status: int, reason: str) -> None:
    answer = upload(client, *files) if files else client.post("runs", files=[("other", ("a.csv", b"1"))])
    assert answer.status_code == status
    assert reason in answer.json()["reason"]


def test_an_upload_of_unannounced_length_is_cut_off_too(client: httpx.Client) -> None:
    def endless() -> Iterator[bytes]:
        yield b'--x\r\nContent-Disposition: form-data; name="files"; filename="a.csv"\r\n\r\n'
        for _ in range(40):
            yield bytes(64 << 10)

    form = {"Content-Type": "multipart/form-data; boundary=x"}
    assert client.post("runs", content=endless(), headers=form).status_code == 413


def test_a_sender_who_never_ends_is_given_up(client: httpx.Client) -> None:
    def slow() -> Iterator[bytes]:
        yield b'--x\r\nContent-Disposition: form-data; name="files"; filename="a.csv"\r\n\r\n'
        for _ in range(100):
            yield b"1"
            time.sleep(0.1)

    form = {"Content-Type": "multipart/form-data; boundary=x"}
    assert client.post("runs", content=slow(), headers=form).status_code == 408


def test_a_result_with_settings_of_another_version_shows_its_map_and_says_why_without_scans(
    result: Path, tmp_path: Path
) -> None:
    older = Path(shutil.copytree(result, tmp_path / "older"))
    (older / "settings.toml").write_text("[merging]\nbygone = 1\n")
    told = [unpack(message)[0] for message in replay(older, Truth.beside(BASEMENT))]
    assert [message["kind"] for message in told] == ["opening", "poses", "room", "report", "note"]
    assert "The scans cannot be shown: settings.toml: unknown key merging.bygone" in told[-1]["says"]

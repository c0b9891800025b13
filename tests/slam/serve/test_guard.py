"""Who may speak with the server: its own page under this machine's names, and nobody else."""

import pytest

from slam.serve.guard import is_loopback, refusal

LOCAL, OPEN = "127.0.0.1", "0.0.0.0"


@pytest.mark.parametrize("host", ["127.0.0.1:8765", "localhost:8765", "LOCALHOST:80", "[::1]:8765", "127.0.0.1"])
@pytest.mark.parametrize("served", [LOCAL, OPEN])
def test_this_machine_may_be_called_by_its_own_names(host: str, served: str) -> None:
    assert refusal(host, None, served) is None
    assert refusal(host, f"http://{host}", served) is None


@pytest.mark.parametrize(
    "host", ["evil.example:8765", "127.0.0.1.evil.example", "localhost.evil.example", "", "192.0.2.7:80"]
)
def test_a_name_that_somebody_pointed_here_is_refused(host: str) -> None:
    assert "does not answer to the name" in str(refusal(host, None, LOCAL))


def test_a_server_for_others_answers_to_its_address_and_given_name_but_to_no_other_name() -> None:
    assert refusal("192.0.2.7:8765", None, OPEN) is None
    assert refusal("robot.lan:8765", None, "robot.lan") is None
    assert refusal("evil.example:8765", None, OPEN) is not None


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "http://localhost:8765"])
def test_a_page_from_elsewhere_is_refused(origin: str) -> None:
    assert "may not use this server" in str(refusal("127.0.0.1:8765", origin, LOCAL))


@pytest.mark.parametrize(
    ("host", "alone"), [("127.0.0.1", True), ("localhost", True), ("::1", True), ("0.0.0.0", False), ("robot", False)]
)
def test_it_is_known_whether_others_can_reach_the_server(host: str, alone: bool) -> None:
    assert is_loopback(host) is alone

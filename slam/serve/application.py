"""The routes: the page, the runs with their live messages, uploads, planners' answers and files to take away."""

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import asdict
from http import HTTPStatus
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from slam.planning import PLANNERS
from slam.result_folder import MAP
from slam.serve.downloads import DOWNLOADS, fetch
from slam.serve.gallery import Gallery, Shown
from slam.serve.guard import Guard
from slam.serve.routes import Question, route
from slam.serve.run import Run, State
from slam.serve.uploads import receive_upload
from slam.serve.worker import TaskError

PAGE = Path(__file__).parent / "page"
MOST_ASKED = 4096  # bytes of a question to the planners
GONE = 4404  # to a websocket: there is no such run


def application(gallery: Gallery, shown: Shown | None, host: str) -> Starlette:
    """The web application of a gallery, which shows a recording or result from the start."""

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        if shown is not None:
            gallery.show(shown)
        yield
        await gallery.close()

    routes = [
        Route("/", _page),
        Route("/runs", _list, methods=["GET"]),
        Route("/runs", _upload, methods=["POST"]),
        Route("/runs/{number:int}/stop", _stop, methods=["POST"]),
        Route("/runs/{number:int}/route", _route, methods=["POST"]),
        Route("/runs/{number:int}/files/{name}", _file),
        WebSocketRoute("/runs/{number:int}/live", _live),
        Mount("/page", StaticFiles(directory=PAGE)),
    ]
    errors: dict[Any, Any] = {HTTPException: _refused}
    made = Starlette(
        routes=routes, lifespan=lifespan, exception_handlers=errors, middleware=[Middleware(Guard, host=host)]
    )
    made.state.gallery = gallery
    return made


async def _page(_: Request) -> Response:
    return FileResponse(PAGE / "index.html")


async def _list(request: Request) -> Response:
    """The runs, and what the page may offer."""
    gallery: Gallery = request.app.state.gallery
    return JSONResponse(
        {
            "runs": [{"number": number, "name": run.name, "state": run.state} for number, run in gallery.runs.items()],
            "planners": list(PLANNERS),
            "files": [{"name": name, "file": one.file, "says": one.says} for name, one in DOWNLOADS.items()],
            "limits": asdict(gallery.limits),
        }
    )


async def _upload(request: Request) -> Response:
    """A recording from outside becomes a run."""
    gallery: Gallery = request.app.state.gallery
    number, folder = gallery.new_place()
    source = await receive_upload(request, folder, gallery.limits)
    gallery.merge_stranger(number, source)
    return JSONResponse({"number": number}, HTTPStatus.CREATED)


async def _stop(request: Request) -> Response:
    await _run(request).stop()
    return Response(status_code=HTTPStatus.NO_CONTENT)


async def _route(request: Request) -> Response:
    """One planner's answer; a robot that cannot stand where it should is an answer, too."""
    gallery: Gallery = request.app.state.gallery
    result = _finished(request)
    question = await _question(request)
    try:
        answer = await gallery.desk.ask(gallery.limits.seconds_planning, route, result / MAP, question)
    except TaskError as reason:
        return JSONResponse({"answer": "refused", "reason": str(reason)})
    return JSONResponse(answer)


async def _file(request: Request) -> Response:
    """One format of the result, written now."""
    gallery: Gallery = request.app.state.gallery
    name, result = request.path_params["name"], _finished(request)
    if name not in DOWNLOADS:
        raise HTTPException(HTTPStatus.NOT_FOUND, f"no format {name!r}; there are {', '.join(DOWNLOADS)}")
    folder = Path(mkdtemp(dir=gallery.scratch))
    try:
        made: Path = await gallery.desk.ask(gallery.limits.seconds_planning, fetch, result, name, folder)
    except TaskError as reason:
        raise HTTPException(HTTPStatus.UNPROCESSABLE_ENTITY, str(reason)) from reason
    return FileResponse(made, filename=made.name, background=BackgroundTask(made.unlink))


async def _live(socket: WebSocket) -> None:
    """Every message of a run, from the first on."""
    gallery: Gallery = socket.app.state.gallery
    run = gallery.runs.get(socket.path_params["number"])
    await socket.accept()
    if run is None:
        await socket.close(GONE, "there is no such run")
        return
    halves = {asyncio.create_task(_tell(socket, run)), asyncio.create_task(_hear_farewell(socket))}
    _, unfinished = await asyncio.wait(halves, return_when=asyncio.FIRST_COMPLETED)
    for half in unfinished:
        half.cancel()
    await asyncio.gather(*halves, return_exceptions=True)


async def _tell(socket: WebSocket, run: Run) -> None:
    with suppress(WebSocketDisconnect):
        async for message in run.follow():
            await socket.send_bytes(message)
        await socket.close()


async def _hear_farewell(socket: WebSocket) -> None:
    """Wait until the page is gone; it has nothing else to say."""
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass


async def _refused(_: Request, reason: Exception) -> Response:
    if not isinstance(reason, HTTPException):
        raise reason
    return JSONResponse({"reason": reason.detail}, reason.status_code)


def _run(request: Request) -> Run:
    gallery: Gallery = request.app.state.gallery
    run = gallery.runs.get(request.path_params["number"])
    if run is None:
        raise HTTPException(HTTPStatus.NOT_FOUND, f"there is no run {request.path_params['number']}")
    return run


def _finished(request: Request) -> Path:
    """The result folder of the run that is asked about, which must be there whole."""
    run = _run(request)
    if run.state is not State.DONE and not (run.result / MAP).exists():
        raise HTTPException(HTTPStatus.CONFLICT, f"{run.name} is {run.state}: there is no map of it yet")
    return run.result


async def _question(request: Request) -> Question:
    """What is asked of the planners, checked field by field."""
    body = b""
    async for block in request.stream():
        body += block
        if len(body) > MOST_ASKED:
            raise HTTPException(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"a question has at most {MOST_ASKED} bytes")
    try:
        asked = json.loads(body)
        start, goal = ((float(asked[end][0]), float(asked[end][1])) for end in ("start", "goal"))
        question = Question(str(asked["planner"]), str(asked["robot"]), start, goal)
    except (ValueError, KeyError, TypeError, IndexError) as damage:
        raise HTTPException(HTTPStatus.BAD_REQUEST, f"not a question to a planner: {damage!r}") from damage
    if question.planner not in PLANNERS:
        raise HTTPException(HTTPStatus.BAD_REQUEST, f"no planner {question.planner!r}")
    return question

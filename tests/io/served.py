"""A local web server that stands for the repository of the published stone sets."""

from contextlib import contextmanager
from functools import partial
from hashlib import sha256
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

from drystone.io.published import PublishedFile, PublishedSet

COMMIT = "0123456789abcdef0123456789abcdef01234567"
CONTENTS = {"toy/R.png": b"regular stones", "toy/IR.png": b"irregular stones"}


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        """Say nothing."""


def toy_set():
    """Return a set of two small files."""
    files = (
        PublishedFile(
            name, f"{COMMIT}/Tests/{Path(name).stem}/labels.png", sha256(data).hexdigest()
        )
        for name, data in CONTENTS.items()
    )
    return PublishedSet("stones to play with", "Nobody (2000)", tuple(files))


def lay_open(root):
    """Write the files as the repository has them, under their commit."""
    for file in toy_set().files:
        path = root / file.address
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(CONTENTS[file.name])
    return root


def lay_down(folder, *names):
    """Write files as they are kept here."""
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(CONTENTS[name])
    return folder


@contextmanager
def serving(root):
    """Serve a folder on this machine; yield its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=root))
    thread = Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def nobody():
    """Return an address of this machine where nobody answers."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Quiet)
    port = server.server_address[1]
    server.server_close()
    return f"http://127.0.0.1:{port}"

"""A page of the laboratory that saves a run, without a browser."""

import base64
import hashlib
import hmac
import json
import os
import re
import socket
import struct

TAB, NONCE = "00112233445566778899aabbccddeeff", "0123456789abcdef0123456789abcdef"


def code(key, text):
    return hmac.new(key.encode(), text.encode(), hashlib.sha256).hexdigest()


class Page:
    """A WebSocket to the laboratory at an address with its token."""

    def __init__(self, address):
        port, token = re.search(r"127\.0\.0\.1:(\d+)/#token=(\w+)", address).groups()
        self.socket = socket.create_connection(("127.0.0.1", int(port)), timeout=60)
        proof = code(code(token, TAB), f"page {NONCE}")
        lines = [
            "GET /ws HTTP/1.1",
            f"Host: 127.0.0.1:{port}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}",
            f"Sec-WebSocket-Protocol: slipfront.lab.v2, tab.{TAB}, nonce.{NONCE}, proof.{proof}",
        ]
        self.socket.sendall("\r\n".join([*lines, "", ""]).encode())
        self.stream = self.socket.makefile("rb")
        status = self.stream.readline()
        if b" 101 " not in status:
            raise ValueError(f"the laboratory answers {status}")
        while self.stream.readline().strip():
            pass

    def send(self, request):
        text = json.dumps(request).encode()
        length = bytes([0x80 | len(text)]) if len(text) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(text))
        # A mask of zeros changes nothing.
        self.socket.sendall(b"\x81" + length + bytes(4) + text)

    def replies(self):
        """The messages of the laboratory, pictures left out."""
        while head := self.stream.read(2):
            length = head[1]
            if length == 126:
                length = struct.unpack(">H", self.stream.read(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self.stream.read(8))[0]
            content = self.stream.read(length)
            if head[0] == 0x81:
                yield json.loads(content)


def save(address, name):
    """Lets the laboratory save its run, and waits until it says that it has."""
    page = Page(address)
    page.send({"do": "open", "source": {}})
    asked = False
    for reply in page.replies():
        if reply["is"] == "case" and not asked:
            asked = True
            page.send({"do": "save", "name": name})
        elif reply["is"] == "saved":
            return
        elif reply["is"] in ("refused", "failed"):
            raise ValueError(f"the laboratory says {reply}")
    raise ValueError("the laboratory has ended")

"""What a job of CI reaches: packages, also damaged ones, an LFS server, and the comments of GitHub and GitLab.

    server.py PACKAGES OBJECTS COMMENTS.json     prints its port; OBJECTS: LFS files by SHA-256

Packages are at /packages; at /token with the header "JOB-TOKEN: secret" alone; at /changed, /cut, /short and /gone each .deb has
another byte, ends before its length, is a shorter file, is absent.
"""

import http.server
import json
import re
import sys
from pathlib import Path

PACKAGES, OBJECTS, COMMENTS = map(Path, sys.argv[1:])
TOKEN = "a-token"
comments = []


def damaged(kind, body):
    """(body, length that the head has)"""
    if kind == "changed":
        return body[:-1] + bytes([body[-1] ^ 1]), len(body)
    if kind == "short":
        return body[: len(body) // 2], len(body) // 2
    return (body[: len(body) // 2] if kind == "cut" else body), len(body)


class Handler(http.server.BaseHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def answer(self, code, body=b"", length=None):
        if not isinstance(body, bytes):
            body = json.dumps(body).encode()
        self.send_response(code)
        self.send_header("Content-Type", "application/vnd.git-lfs+json")  # git-lfs takes no other; no one else minds
        self.send_header("Content-Length", str(len(body) if length is None else length))
        self.end_headers()
        self.wfile.write(body)
        self.close_connection = True

    def body(self):
        return json.loads(self.rfile.read(int(self.headers["Content-Length"])))

    def is_allowed(self):
        return TOKEN in (self.headers.get("PRIVATE-TOKEN"), (self.headers.get("Authorization") or "").removeprefix("Bearer "))

    def do_GET(self):
        path = self.path.split("?")[0]
        if package := re.fullmatch(r"/(packages|token|changed|cut|short|gone)/([\w.+-]+)", path):
            kind, name = package.groups()
            file = PACKAGES / name
            is_package = name.endswith(".deb")
            if not file.is_file() or (kind == "gone" and is_package):
                return self.answer(404)
            if kind == "token" and self.headers.get("JOB-TOKEN") != "secret":
                return self.answer(401)
            return self.answer(200, *damaged(kind if is_package else "packages", file.read_bytes()))
        if thing := re.fullmatch(r"/lfs/files/([0-9a-f]{64})", path):
            file = OBJECTS / thing[1]
            return self.answer(200, file.read_bytes()) if file.is_file() else self.answer(404)
        if path.startswith(("/github/", "/gitlab/")) and not self.is_allowed():
            return self.answer(403)
        if path == "/gitlab/user":
            return self.answer(200, {"id": 5})
        if re.fullmatch(r"/github/repos/user/user/issues/7/comments|/gitlab/projects/1/merge_requests/7/notes", path):
            return self.answer(200, comments if "page=1" in self.path.split("?")[1].split("&") else [])
        return self.answer(404)

    def do_POST(self):
        if self.path == "/lfs/objects/batch":
            host = self.headers["Host"]
            objects = [{**thing, "actions": {"download": {"href": f"http://{host}/lfs/files/{thing['oid']}"}}}
                       for thing in self.body()["objects"]]
            return self.answer(200, {"transfer": "basic", "objects": objects})
        if not self.is_allowed():
            return self.answer(403)
        comments.append({"id": len(comments) + 1, "user": {"type": "Bot"}, "author": {"id": 5}, "changes": 0, **self.body()})
        return self.kept()

    def change(self):
        found = re.search(r"/(?:issues/comments|merge_requests/7/notes)/(\d+)$", self.path)
        if not found or not self.is_allowed():
            return self.answer(403)
        comment = comments[int(found[1]) - 1]
        comment.update(self.body(), changes=comment["changes"] + 1)
        return self.kept()

    do_PATCH = do_PUT = change

    def kept(self):
        COMMENTS.write_text(json.dumps(comments, indent=1))
        self.answer(201, comments[-1])


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_address[1], flush=True)
server.serve_forever()

# SPDX-License-Identifier: Apache-2.0
"""Tokens and certificates."""

import subprocess

import pytest
import weft
from conftest import KEY


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    """A server that wants tokens, over TLS and over its socket; its TLS address and certificate."""
    folder = tmp_path_factory.mktemp("guarded")
    (folder / "tokens").write_text("ada secret-of-ada-0016\n")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                    "ec_paramgen_curve:prime256v1", "-nodes", "-days", "1", "-subj", "/CN=weft.test",
                    "-addext", "subjectAltName=DNS:weft.test", "-keyout", folder / "key.pem",
                    "-out", folder / "cert.pem"], check=True, capture_output=True)
    with weft.LocalServer(arguments=[
            "--listen", "127.0.0.1:0", "--tls-cert", str(folder / "cert.pem"), "--tls-key",
            str(folder / "key.pem"), "--tokens", str(folder / "tokens"), "--data",
            str(folder / "data")]) as server:
        server.tcp = next(address for address in server.addresses if address.startswith("127.0.0.1:"))
        server.certificate = folder / "cert.pem"
        yield server


def test_a_token_lets_in(guarded):
    with weft.Client(guarded.target, token="secret-of-ada-0016") as client:
        assert client.mesh(KEY).digest
        assert client.server_info().version


def test_a_job_names_the_client_that_submitted_it(guarded):
    with weft.Client(guarded.target, token="secret-of-ada-0016") as client:
        job = client.submit(KEY)
        assert job.client == "ada"
        assert [kept.client for kept in client.list_jobs()] == ["ada"]


@pytest.mark.parametrize("token", ["", "wrong"])
def test_no_token_and_a_wrong_one_are_refused(guarded, token):
    with weft.Client(guarded.target, token=token) as client:
        with pytest.raises(weft.Unauthenticated, match="UNAUTHENTICATED"):
            client.mesh(KEY)


def test_the_token_of_the_environment_is_taken(guarded, monkeypatch):
    monkeypatch.setenv("WEFT_TOKEN", "secret-of-ada-0016\n")
    monkeypatch.setenv("WEFT_SERVER", guarded.target)
    with weft.Client() as client:
        assert client.server_info().version


def test_tls_trusts_the_ca_it_is_given(guarded):
    tls = weft.TLS(ca=guarded.certificate, server_name="weft.test")
    with weft.Client(guarded.tcp, tls=tls, token="secret-of-ada-0016") as client:
        assert client.mesh(KEY).digest


def test_tls_does_not_trust_everyone(guarded):
    with weft.Client(guarded.tcp, tls=True, retries=0) as client:
        with pytest.raises(weft.Unavailable):
            client.server_info()


def test_a_token_does_not_travel_unencrypted_to_other_machines():
    with pytest.raises(weft.WeftError, match="unencrypted to mesh.example.org:7421"):
        weft.Client("mesh.example.org:7421", token="secret")
    for target in ("localhost:1", "127.0.0.1:1", "[::1]:1", "unix:/nobody"):
        weft.Client(target, token="secret").close()


def test_a_token_that_is_none_is_refused():
    with pytest.raises(weft.WeftError, match="token"):
        weft.Client("localhost:1", token="two words")

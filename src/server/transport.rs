//! Messages as bytes: what lies between a client and [`Connection`].
//!
//! The reader survives what is no message: it goes on with the next header.

use std::io::{self, BufRead, Read, Write};
use std::thread;

use lsp_server::{Connection, ErrorCode, Message, Notification, RequestId, ResponseError};
use serde_json::{Value, json};

use super::main_loop::{Ended, run};

/// Name of the notification that stands for a message that is none. It never comes from a client.
pub(super) const MALFORMED: &str = "$/plclint/malformed";

/// Longest message in bytes. A text of 500 MB escaped as JSON is the largest that a client may want to send.
const MAX_LENGTH: u64 = 1 << 30;

/// Serves one client until it ends the session or goes away.
pub fn serve<R, W>(input: R, output: W) -> io::Result<Ended>
where
    R: BufRead + Send + 'static,
    W: Write + Send + 'static,
{
    let (server, client) = Connection::memory();
    let Connection { sender, receiver } = client;
    // Not joined: it may wait for input for ever, and the process is about to end.
    thread::Builder::new().name("reader".to_owned()).spawn(move || {
        let mut input = input;
        while let Ok(Some(message)) = read(&mut input) {
            let is_exit = matches!(&message, Message::Notification(it) if it.method == "exit");
            if sender.send(message).is_err() || is_exit {
                break;
            }
        }
    })?;
    let writer = thread::Builder::new().name("writer".to_owned()).spawn(move || {
        let mut output = output;
        // A client that has gone is noticed by the reader.
        let _ = receiver.iter().try_for_each(|it| it.write(&mut output));
    })?;
    let ended = run(server);
    let _ = writer.join();
    Ok(ended)
}

/// The next message; `None` at the end of the input.
fn read(input: &mut impl BufRead) -> io::Result<Option<Message>> {
    let mut length: Option<u64> = None;
    loop {
        let mut line = Vec::new();
        // A header is short: what is not is no header.
        if input.by_ref().take(4096).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        match line.trim_end_matches(['\r', '\n']) {
            "" => {
                let Some(length) = length.take() else { continue };
                return body(input, length);
            }
            header => {
                if let Some((name, value)) = header.split_once(':')
                    && name.trim().eq_ignore_ascii_case("content-length")
                {
                    length = value.trim().parse().ok();
                }
            }
        }
    }
}

fn body(input: &mut impl BufRead, length: u64) -> io::Result<Option<Message>> {
    if length > MAX_LENGTH {
        io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        return Ok(Some(malformed(&Value::Null, "the message is too long")));
    }
    let mut bytes = Vec::new();
    let read = input.by_ref().take(length).read_to_end(&mut bytes)?;
    if (read as u64) < length {
        return Ok(None);
    }
    let message = match serde_json::from_slice::<Value>(&bytes) {
        Ok(value) => {
            let id = value.get("id").cloned().unwrap_or_default();
            serde_json::from_value(value).unwrap_or_else(|error| malformed(&id, &error.to_string()))
        }
        Err(error) => malformed(&Value::Null, &error.to_string()),
    };
    Ok(Some(message))
}

fn malformed(id: &Value, error: &str) -> Message {
    let params = json!({ "id": id, "error": error });
    Message::Notification(Notification { method: MALFORMED.to_owned(), params })
}

/// What [`malformed`] told: the request that waits for an answer, if there is one, and the error.
pub(super) fn told(params: &Value) -> (Option<RequestId>, ResponseError) {
    let id = params.get("id").and_then(|it| serde_json::from_value(it.clone()).ok());
    let error = params.get("error").and_then(Value::as_str).unwrap_or_default();
    let message = format!("this is no message: {error}");
    (id, ResponseError { code: ErrorCode::InvalidRequest as i32, message, data: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(input: &[u8]) -> Vec<String> {
        let mut input = input;
        std::iter::from_fn(|| read(&mut input).unwrap())
            .map(|it| match it {
                Message::Request(it) => it.method,
                Message::Notification(it) => it.method,
                Message::Response(it) => format!("response {}", it.id),
            })
            .collect()
    }

    #[test]
    fn what_is_no_message_is_passed_by() {
        let frame = |body: &str| format!("Content-Length: {}\r\n\r\n{body}", body.len());
        let good = frame(r#"{"jsonrpc":"2.0","method":"exit"}"#);
        assert_eq!(messages(good.as_bytes()), ["exit"]);
        let input = format!("{}{good}", frame("{\"jsonrpc\": nonsense"));
        assert_eq!(messages(input.as_bytes()), [MALFORMED, "exit"]);
        let input = format!("{}{good}", frame(r#"{"id":7}"#));
        assert_eq!(messages(input.as_bytes()), [MALFORMED, "exit"]);
        let input = format!("noise\r\nContent-Length: many\r\n\r\n{good}");
        assert_eq!(messages(input.as_bytes()), ["exit"]);
        assert_eq!(messages(b"Content-Length: 100\r\n\r\n{"), [] as [&str; 0], "cut short");
        assert_eq!(messages(b"Content-Length: 99999999999999999999\r\n\r\n"), [] as [&str; 0]);
        assert_eq!(messages(b"content-length:2\n\n{}"), [MALFORMED]);
    }
}

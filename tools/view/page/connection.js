// The WebSocket to the server. A connection that is lost is tried again, after longer and longer waits.
// SPDX-License-Identifier: Apache-2.0
import {parseFrame} from "./frame_message.js";
import {retryDelayMs} from "./retry.js";

export class Connection {
  /// @param handlers  message(object), frame({ header, bytes }), opened(), lost(seconds until the next try),
  ///                  problem(text)
  constructor(handlers) {
    this.handlers_ = handlers;
    this.failures_ = 0;
    this.open_();
  }

  /// Sends an object as JSON. Without a connection it is dropped: the scene comes anew with the next one.
  send(message) {
    if (this.socket_.readyState === WebSocket.OPEN) this.socket_.send(JSON.stringify(message));
  }

  /// Tries again now.
  retryNow() {
    clearTimeout(this.timer_);
    if (this.socket_.readyState === WebSocket.CLOSED) this.open_();
  }

  open_() {
    const address = new URL("socket", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.addEventListener("open", () => {
      this.failures_ = 0;
      this.handlers_.opened();
    });
    socket.addEventListener("message", (event) => this.receive_(event.data));
    socket.addEventListener("close", () => {
      const delay = retryDelayMs(this.failures_++);
      this.handlers_.lost(delay / 1000);
      this.timer_ = setTimeout(() => this.open_(), delay);
    });
    this.socket_ = socket;
  }

  receive_(data) {
    try {
      if (typeof data === "string")
        this.handlers_.message(JSON.parse(data));
      else
        this.handlers_.frame(parseFrame(data));
    } catch (error) {
      console.error(error);
      this.handlers_.problem(`a message of the server could not be used: ${error.message}`);
    }
  }
}

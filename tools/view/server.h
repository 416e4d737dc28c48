// Serves a viewer's page and its messages over HTTP and WebSocket.
//
// Whoever may open the port may not look without the token, which is part of every address. A page of another site
// cannot connect either: requests need the server's own name (Host), against names that are turned to this machine
// later, and upgrades and files its own page (Origin).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "view/viewer.h"

namespace umbrick::view {

struct ServerOptions {
  std::string host = "127.0.0.1";  // the address of a network card, numbers alone
  std::uint16_t port = 0;          // 0: any that is free
  std::string token = {};          // empty: 128 random bits
};

/// Pages at most, and connections of all kinds.
inline constexpr int kMostPages = 8, kMostConnections = 64;

class ViewServer {
 public:
  /// Opens the port. @param viewer  outlives this
  /// @throw IoError  the port is taken or not allowed  @throw InvalidArgument  the host is no address
  ViewServer(Viewer& viewer, const ServerOptions& options);
  ~ViewServer();

  std::uint16_t port() const;
  /// Returns the address of the page: http://127.0.0.1:8080/<token>/
  std::string address() const;
  /// Serves until it is to stop, which it asks about ten times a second.
  void run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace umbrick::view

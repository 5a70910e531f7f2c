#pragma once

// What keeps a gateway that other machines reach to those who have its secret: each packet is
// followed by a tag that only they can make, over a number that is drawn anew for each client, so
// that what somebody recorded before is worth nothing.

#include <array>
#include <cstdint>

#include "device/protocols/bytes.hpp"
#include "device/protocols/gateway.hpp"

namespace torsion::engine {

inline constexpr std::size_t kGatewayTagSize = 16;
using GatewayTag = std::array<std::uint8_t, kGatewayTagSize>;

/// That of a client which has been told none yet.
inline constexpr GatewayNonce kNoNonce{};

/// The first 16 bytes of HMAC-SHA-256 of the nonce and then the packet (RFC 2104, RFC 4868).
GatewayTag authentication_tag(Bytes secret, const GatewayNonce& nonce, Bytes packet);

/// Whether the last 16 bytes are the tag of those before. Takes as long for every wrong one.
bool is_authentic(Bytes secret, const GatewayNonce& nonce, Bytes packet_and_tag);

/// One that nobody can foretell.
GatewayNonce draw_nonce();

}  // namespace torsion::engine

#include "device/gateway/authentication.hpp"

#include <algorithm>

#include <sodium.h>

namespace torsion::engine {

GatewayTag authentication_tag(Bytes secret, const GatewayNonce& nonce, Bytes packet) {
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, secret.data(), secret.size());
  crypto_auth_hmacsha256_update(&state, nonce.data(), nonce.size());
  crypto_auth_hmacsha256_update(&state, packet.data(), packet.size());
  std::array<std::uint8_t, crypto_auth_hmacsha256_BYTES> whole{};
  crypto_auth_hmacsha256_final(&state, whole.data());
  GatewayTag tag{};
  std::copy_n(whole.begin(), tag.size(), tag.begin());
  return tag;
}

bool is_authentic(Bytes secret, const GatewayNonce& nonce, Bytes packet_and_tag) {
  if (packet_and_tag.size() < kGatewayTagSize) {
    return false;
  }
  const std::size_t size = packet_and_tag.size() - kGatewayTagSize;
  const GatewayTag tag = authentication_tag(secret, nonce, packet_and_tag.first(size));
  return sodium_memcmp(tag.data(), packet_and_tag.data() + size, tag.size()) == 0;
}

GatewayNonce draw_nonce() {
  [[maybe_unused]] const int is_ready = sodium_init();
  GatewayNonce nonce{};
  randombytes_buf(nonce.data(), nonce.size());
  return nonce;
}

}  // namespace torsion::engine

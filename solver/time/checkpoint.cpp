// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time/checkpoint.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/write_file.hpp"

namespace esfem {
namespace {

using nlohmann::json;

constexpr std::size_t checksum_length = 16;

/// FNV-1a with 64 bits, in hexadecimal digits.
std::string checksum(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  return format("%016llx", static_cast<unsigned long long>(hash));
}

std::string cbor(const json& value) {
  std::string bytes;
  json::to_cbor(value, bytes);
  return bytes;
}

/// The key that two identities do not share, in words.
std::string difference(const json& found, const json& expected) {
  for (const auto& [key, value] : expected.items())
    if (!found.contains(key) || found.at(key) != value) return "another " + key;
  return "";
}

}  // namespace

json packed(const Field& field) {
  std::vector<std::uint8_t> bytes(field.size() * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), field.data(), bytes.size());
  return {{"rows", field.rows()}, {"columns", field.cols()}, {"values", json::binary(std::move(bytes))}};
}

Field unpacked(const json& value) {
  const auto rows = value.at("rows").get<std::size_t>(), columns = value.at("columns").get<std::size_t>();
  const std::vector<std::uint8_t>& bytes = value.at("values").get_binary();
  if (bytes.size() != rows * columns * sizeof(double))
    throw InputError(format("%zu bytes for %zu x %zu numbers", bytes.size(), rows, columns));
  Field field(rows, columns);
  if (!bytes.empty()) std::memcpy(field.data(), bytes.data(), bytes.size());
  return field;
}

std::string seal(const json& value) {
  const std::string bytes = cbor(value);
  return checksum(bytes) + bytes;
}

json unseal(const std::string& bytes) {
  const json damaged(json::value_t::discarded);
  if (bytes.size() < checksum_length) return damaged;
  const std::string content = bytes.substr(checksum_length);
  if (bytes.compare(0, checksum_length, checksum(content)) != 0) return damaged;
  return json::from_cbor(content, /*strict=*/true, /*allow_exceptions=*/false);
}

Checkpoint::Checkpoint(std::string file, json description, double seconds)
    : file_(std::move(file)), description_(std::move(description)), interval_(seconds) {
  if (!(seconds >= 0)) throw InputError(format("checkpoint every %g seconds: expected 0 or more", seconds));
  const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": this folder cannot be made: " + error.message());
}

void Checkpoint::attach(std::function<json()> save, std::function<void(const json&)> load) {
  companions_.push_back({std::move(save), std::move(load)});
}

void Checkpoint::identify(const json& grid, const json& initial) {
  identity_ = {
      {"description", description_}, {"time grid", grid}, {"initial state", checksum(cbor(initial))}};
}

bool Checkpoint::read(const std::function<void(const json&)>& restore) {
  remark_.clear();
  std::ifstream stream(file_, std::ios::binary);
  if (!stream) return false;
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  const json content = unseal(bytes.str());
  try {
    if (!content.is_object()) throw InputError("damaged");
    const std::string other = difference(content.at("identity"), identity_);
    if (!other.empty()) throw InputError(other);
    restore(content.at("run"));
    return true;
  } catch (const json::exception& error) {
    remark_ = error.what();
  } catch (const std::runtime_error& error) {
    remark_ = error.what();
  }
  remark_ = file_ + ": this checkpoint is not used: " + remark_;
  return false;
}

void Checkpoint::load_attached(const json& saved) {
  if (saved.size() != companions_.size())
    throw InputError(format("%zu parts beside the flow, expected %zu", saved.size(), companions_.size()));
  std::vector<json> before;
  for (const Companion& companion : companions_) before.push_back(companion.save());
  try {
    for (std::size_t i = 0; i < companions_.size(); ++i) companions_[i].load(saved[i]);
  } catch (const std::exception&) {
    for (std::size_t i = 0; i < companions_.size(); ++i) companions_[i].load(before[i]);
    throw;
  }
}

void Checkpoint::write(json run) {
  run["attached"] = json::array();
  for (const Companion& companion : companions_) run["attached"].push_back(companion.save());
  write_file(file_, seal({{"identity", identity_}, {"run", std::move(run)}}));
  saved_ = std::chrono::steady_clock::now();
}

void Checkpoint::remove() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace esfem

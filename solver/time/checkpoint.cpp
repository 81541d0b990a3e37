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

std::string cbor(const json& value) {
  std::string bytes;
  json::to_cbor(value, bytes);
  return bytes;
}

std::string shown(const json& value) {
  return value.is_null() ? "none" : value.dump();
}

/// The differences of `found` from `asked`, in words; "" when they are equal. `where`
/// follows each of the keys.
std::string difference(const json& found, const json& asked, const std::string& where = "") {
  std::string words;
  json all = found;
  all.update(asked);
  for (const auto& [key, unused] : all.items()) {
    const json there = found.value(key, json()), here = asked.value(key, json());
    if (there == here) continue;
    words += words.empty() ? "" : ", ";
    if (there.is_object() && here.is_object())
      words += difference(there, here, " in " + key + where);
    else if (there.is_array() || here.is_array())
      words += "another " + key + where;
    else
      words += format("another %s%s (it has %s, %s is asked for)", key.c_str(), where.c_str(),
                      shown(there).c_str(), shown(here).c_str());
  }
  return words;
}

/// Of two identities; their parts need not be named.
std::string other_run(const json& found, const json& asked) {
  std::string words;
  for (const auto& [part, value] : asked.items()) {
    const std::string differs = difference(found.at(part), value);
    words += (words.empty() || differs.empty() ? "" : ", ") + differs;
  }
  return words;
}

}  // namespace

std::string checksum(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  return format("%016llx", static_cast<unsigned long long>(hash));
}

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
  try {
    return json::from_cbor(content);
  } catch (const json::exception&) {  // arrays of impossible size throw even where exceptions are disallowed
    return damaged;
  }
}

Checkpoint::Checkpoint(std::string file, json description, double seconds, Say say)
    : file_(std::move(file)),
      description_(std::move(description)),
      interval_(seconds),
      say_(say ? std::move(say) : [](const std::string&) {}) {
  if (!(seconds >= 0)) throw InputError(format("checkpoint every %g seconds: expected 0 or more", seconds));
  prepare_output(file_);
}

void Checkpoint::attach(std::function<json()> save, std::function<void(const json&)> load) {
  companions_.push_back({std::move(save), std::move(load)});
}

void Checkpoint::identify(const json& grid, const json& initial) {
  identity_ = {{"description", description_},
               {"grid", grid},
               {"initial", {{"initial state", json::array({checksum(cbor(initial))})}}}};
}

bool Checkpoint::read(const std::function<std::string(const json&)>& restore) {
  std::error_code ignored;
  if (!std::filesystem::exists(file_, ignored)) return false;
  std::ifstream stream(file_, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  const json content = unseal(bytes.str());
  std::string why;
  try {
    if (!stream) throw InputError("it cannot be read");
    if (!content.is_object()) throw InputError("it is damaged, or no checkpoint");
    const std::string other = other_run(content.at("identity"), identity_);
    if (!other.empty()) throw InputError("it is of " + other);
    say_(file_ + ": the run resumes from this checkpoint, " + restore(content.at("run")));
    return true;
  } catch (const json::exception& error) {
    why = error.what();
  } catch (const InputError& error) {
    why = error.what();
  }
  why = file_ + ": this checkpoint cannot be used: " + why;
  if (!starts_afresh_)
    throw InputError(why + "; it is left unchanged: remove it, or name another file, to start at t = 0");
  say_(why + "; the run starts at t = 0");
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
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
  run["seconds"] = seconds_before_ + elapsed.count();
  run["attached"] = json::array();
  for (const Companion& companion : companions_) run["attached"].push_back(companion.save());
  if (keeps_previous_) keep_previous();
  write_file(file_, seal({{"identity", identity_}, {"run", std::move(run)}}));
  keeps_previous_ = false;
  saved_ = std::chrono::steady_clock::now();
}

void Checkpoint::keep_previous() const {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::copy_file(file_, file_ + ".previous", fs::copy_options::overwrite_existing, error);
  if (error) fs::remove(file_ + ".previous", error);
}

}  // namespace esfem

// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include "experiments/evolve/entry.hpp"
#include "solver/error.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> list;
    for (const auto& of_file :
         {mean_curvature_entries, dziuk_entries, bgn_entries, generalised_mean_curvature_entries,
          willmore_entries, helfrich_entries, willmore_competitor_entries, coupled_diffusion_entries,
          kinetics_entries, cahn_hilliard_entries, mixture_entries})
      for (Entry& entry : of_file()) list.push_back(std::move(entry));
    return list;
  }();
  return all;
}

const Entry& entry_named(const std::string& flow, const std::string& problem, const std::string& source) {
  std::set<std::string> flows, problems;
  std::string flow_of_problem;
  for (const Entry& entry : entries()) {
    flows.insert(entry.flow);
    if (!flow.empty() && entry.problem == flow) flow_of_problem = entry.flow;
    if (entry.flow != flow) continue;
    if (problem.empty() || problem == entry.problem) return entry;
    problems.insert(entry.problem);
  }
  if (!flow_of_problem.empty())
    throw InputError(source + ": found flow = \"" + flow + "\"; expected \"flow\": \"" + flow_of_problem +
                     "\", \"problem\": \"" + flow + "\"");
  if (flows.count(flow) == 0)
    throw InputError(source + ": found flow = \"" + flow + "\"; expected one of " + listed_for(flow, flows));
  if (problems == std::set<std::string>{""})
    throw InputError(source + ": flow " + flow + " has no problems; expected no key problem");
  throw InputError(source + ": found problem = \"" + problem + "\"; expected one of " +
                   listed_for(problem, problems));
}

}  // namespace esfem

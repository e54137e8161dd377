#include "plugins/energy/formula/program.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace drape::formula {

/// Gives every term that is needed a register, which is free again after its last use.
class Program::Allocator {
 public:
  Allocator(Program& program, const std::vector<Term>& outputs) : program_(program) {
    int count = 0;
    for (const Term& t : outputs)
      if (t.graph) graph_ = t.graph, count = std::max(count, t.node + 1);
    last_use_.assign(count, unused);
    registers_.assign(count, -1);
    for (const Term& t : outputs) need(t, count);
    for (int n = count - 1; n >= 0; --n)
      for (int i = 0; last_use_[n] != unused && i < arguments_of(op_of(n)); ++i)
        need((*graph_)[n].arguments[i], n);
    for (int n = 0; n < count; ++n)
      if (last_use_[n] != unused && op_of(n) == Op::input) add_input(n);
    for (int n = 0; n < count; ++n)
      if (last_use_[n] != unused && op_of(n) != Op::input) emit(n);
    for (const Term& t : outputs) program_.outputs_.push_back(t.graph ? registers_[t.node] : load(t.literal));
  }

 private:
  static constexpr int unused = -1;

  Op op_of(int n) const { return (*graph_)[n].op; }

  /// Notes a reader of a term: a node, or the outputs behind the last node.
  void need(const Term& t, int reader) {
    if (t.graph) last_use_[t.node] = std::max(last_use_[t.node], reader);
  }

  int take_register() {
    if (!free_.empty()) {
      const int r = free_.back();
      free_.pop_back();
      return r;
    }
    if (used_ == most_registers)
      throw std::length_error("the formula needs more than " + std::to_string(most_registers) +
                              " numbers at a time; simplify it");
    return used_++;
  }

  void add_input(int n) {
    const std::size_t number = (*graph_)[n].input;
    if (program_.inputs_.size() <= number) program_.inputs_.resize(number + 1, most_registers);
    program_.inputs_[number] = registers_[n] = take_register();
  }

  int load(double literal) {
    const int r = take_register();
    program_.code_.push_back({Op::load, static_cast<std::uint16_t>(r), 0, 0, 0, literal});
    return r;
  }

  void emit(int n) {
    const TermGraph::Node& node = (*graph_)[n];
    const Term &a = node.arguments[0], &b = node.arguments[1];
    Instruction made;
    made.op = node.op;
    if (node.op == Op::multiply && !a.graph) made.op = Op::scale, made.literal = a.literal;
    if (node.op == Op::multiply_add && !a.graph) made.op = Op::scale_add, made.literal = a.literal;
    if (node.op == Op::add && !a.graph) made.op = Op::offset, made.literal = a.literal;
    if (node.op == Op::add && !b.graph) made.op = Op::offset, made.literal = b.literal;
    if (node.op == Op::subtract && !b.graph) made.op = Op::offset, made.literal = -b.literal;
    if (node.op == Op::subtract && !a.graph) made.op = Op::subtract_from, made.literal = a.literal;
    if (node.op == Op::divide && !a.graph) made.op = Op::divide_into, made.literal = a.literal;
    std::vector<int> loaded;  // registers of literals, free after this
    std::uint16_t read[3] = {0, 0, 0};
    int reads = 0;
    const int count = arguments_of(node.op);
    for (int i = 0; i < count; ++i) {
      const Term& t = node.arguments[i];
      if (t.graph) {
        read[reads++] = registers_[t.node];
      } else if (made.op == node.op || i == 2) {
        loaded.push_back(load(t.literal));
        read[reads++] = loaded.back();
      }
    }
    for (int i = 0; i < count; ++i) release(node.arguments[i], n);
    free_.insert(free_.end(), loaded.begin(), loaded.end());
    // An instruction reads a pack of all its arguments before it writes that pack: it may write over them.
    made.to = registers_[n] = take_register();
    made.a = read[0], made.b = read[1], made.c = read[2];
    program_.code_.push_back(made);
  }

  void release(const Term& t, int reader) {
    if (!t.graph || last_use_[t.node] != reader) return;
    last_use_[t.node] = unused;  // twice an argument: released once
    free_.push_back(registers_[t.node]);
  }

  Program& program_;
  const TermGraph* graph_ = nullptr;
  std::vector<int> last_use_, registers_;  // of each node
  std::vector<int> free_;
  int used_ = 0;
};

Program::Program(const std::vector<Term>& outputs) { Allocator(*this, outputs); }

template <class T, int batch>
void Program::run(T* registers) const {
  for (const Instruction& i : code_) {
    T* to = registers + i.to * batch;
    const T *a = registers + i.a * batch, *b = registers + i.b * batch, *c = registers + i.c * batch;
    const T literal = i.literal;
#define DRAPE_RUN(op, result)                         \
  case Op::op:                                        \
    for (int k = 0; k < batch; ++k) to[k] = (result); \
    break;
#define DRAPE_RUN_OP(op) DRAPE_RUN(op, evaluate<T>(Op::op, a[k], b[k], c[k]))
    switch (i.op) {
      DRAPE_OPS(DRAPE_RUN_OP)
      DRAPE_RUN(load, literal)
      DRAPE_RUN(scale, literal * a[k])
      DRAPE_RUN(scale_add, literal * a[k] + b[k])
      DRAPE_RUN(offset, literal + a[k])
      DRAPE_RUN(subtract_from, literal - a[k])
      DRAPE_RUN(divide_into, literal / a[k])
      case Op::input:
        break;
    }
#undef DRAPE_RUN_OP
#undef DRAPE_RUN
  }
}

template void Program::run<double, 1>(double*) const;
template void Program::run<Pack<native_pack_width>, 1>(Pack<native_pack_width>*) const;
template void Program::run<Pack<native_pack_width>, 8>(Pack<native_pack_width>*) const;

}  // namespace drape::formula

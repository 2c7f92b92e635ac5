// A prepared SQLite statement.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace haustra::records {

/// The error of the connection's last call, as one of ours.
tl::unexpected<Error> failedSql(sqlite3* database, const std::string& doing);

/// Belongs to the thread that uses its connection.
class Statement {
public:
    static Result<Statement> prepare(sqlite3* database, const char* sql);

    void bind(int parameter, std::int64_t value);
    void bind(int parameter, double value);
    void bind(int parameter, const std::string& text);
    void bind(int parameter, std::span<const std::uint8_t> blob);

    /// True: a row is there. False: done. After either, reset() before the next use.
    Result<bool> step();
    void reset();

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    /// Valid until the next step() or reset().
    std::span<const std::uint8_t> blob(int column) const;

private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Resets a statement at the end of a scope, whatever ends it.
class ResetAfter {
public:
    explicit ResetAfter(Statement& statement) : statement_(statement) {}
    ~ResetAfter() { statement_.reset(); }
    ResetAfter(const ResetAfter&) = delete;
    ResetAfter& operator=(const ResetAfter&) = delete;

private:
    Statement& statement_;
};

}  // namespace haustra::records

//! Why a request has no answer.

/// Why a request has no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The code of the protocol.
    pub code: i32,
    /// One sentence.
    pub message: String,
}

/// The codes of JSON-RPC and of the protocol.
const METHOD_NOT_FOUND: i32 = -32601;
const INVALID_PARAMS: i32 = -32602;
const REQUEST_FAILED: i32 = -32803;

impl Refusal {
    /// A request that cannot be served, and why.
    pub fn failed(message: impl Into<String>) -> Refusal {
        Refusal { code: REQUEST_FAILED, message: message.into() }
    }

    /// A request that is not among those of this server.
    pub fn unknown(method: &str) -> Refusal {
        Refusal { code: METHOD_NOT_FOUND, message: format!("`{method}` is not supported") }
    }

    /// Parameters that are not those of the method.
    pub fn malformed(error: &serde_json::Error) -> Refusal {
        Refusal { code: INVALID_PARAMS, message: error.to_string() }
    }
}

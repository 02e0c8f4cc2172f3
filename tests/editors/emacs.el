;;; emacs.el --- Emacs with Eglot as a client of `gapi lsp' -*- lexical-binding: t -*-

;; GAPI=target/debug/gapi emacs --batch -l package -f package-initialize -l tests/editors/emacs.el

;;; Code:

(defvar here (file-name-directory load-file-name))
(add-to-list 'load-path (expand-file-name "../../editors/emacs" here))
(require 'eglot)
(require 'flymake)
(require 'gapilib)

(setq gapilib-program (expand-file-name (getenv "GAPI")))

(defun wait-for (what condition)
  "Wait until CONDITION holds; WHAT is named if it does not."
  (let ((end (+ (float-time) 20)))
    (while (and (not (funcall condition)) (< (float-time) end))
      (accept-process-output nil 0.05)))
  (unless (funcall condition) (error "Not reached: %s" what))
  (message "ok %s" what))

(let* ((folder (make-temp-file "gapilib" t))
       (file (expand-file-name "Decay.mo" folder)))
  (with-temp-file file
    (insert "model Decay\n  parameter Real k = 1;\n  Real x(start = 1);\n"
            "equation\n  der(x) = -kk*x;\nend Decay;\n"))
  (with-current-buffer (find-file-noselect file)
    (unless (eq major-mode 'gapilib-modelica-mode) (error "The mode is %s" major-mode))
    (apply #'eglot--connect (eglot--guess-contact))
    (unless eglot--managed-mode (eglot--maybe-activate-editing-mode))
    (wait-for "the buffer is managed" (lambda () (eglot-managed-p)))
    (flymake-start)
    (wait-for "a diagnostic" (lambda () (flymake-start) (flymake-diagnostics)))
    (goto-char (point-min))
    (search-forward "-kk")
    (delete-char -1)
    (eglot--signal-textDocument/didChange)
    (wait-for "no diagnostic" (lambda () (flymake-start) (null (flymake-diagnostics))))
    (eglot-rename "rate")
    (goto-char (point-min))
    (unless (search-forward "Real rate" nil t) (error "Not renamed"))
    (message "ok renamed")
    (goto-char (point-min))
    (search-forward "Real rate")
    (replace-match "Real   rate")
    (eglot-format-buffer)
    (goto-char (point-min))
    (unless (search-forward "  parameter Real rate = 1;" nil t) (error "Not formatted"))
    (message "ok formatted")
    (set-buffer-modified-p nil)
    (eglot-shutdown (eglot-current-server))
    (message "ok the server has ended")))
;;; emacs.el ends here
